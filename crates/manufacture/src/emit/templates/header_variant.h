/* The number of the variant that MANUFACTURE_VARIANT names; 0 without it. */
int @P@variant(void);
