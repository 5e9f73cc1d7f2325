/* The number of the variant that the environment variable MANUFACTURE_VARIANT names; it is read at
   the first call. 0 is the solution of the file. */
int @P@variant(void)
{
    static const char *const names[@COUNT@] = {
        "",
        @LIST@
    };
    static int chosen = -1;
    if (chosen < 0) {
        const char *name = getenv("MANUFACTURE_VARIANT");
        int place = 0;
        while (name && place < @COUNT@ && strcmp(name, names[place]) != 0) ++place;
        if (place == @COUNT@) {
            fprintf(stderr, "MANUFACTURE_VARIANT: unknown variant `%s`; expected one of", name);
            for (place = 1; place < @COUNT@; ++place) fprintf(stderr, " %s", names[place]);
            fprintf(stderr, "\n");
            exit(2);
        }
@CHANGES@        chosen = place;
    }
    return chosen;
}

@CURRENT@