/* 0, or 1 if no parameter has the name; those that depend on it follow. */
int @P@set_parameter(const char *name, double value);
/* NaN if no parameter has the name. */
double @P@get_parameter(const char *name);
