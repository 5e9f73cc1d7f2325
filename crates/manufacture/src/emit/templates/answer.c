#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "@NAME@.h"

int main(int argc, char **argv)
{
    const char *face = argc > 1 ? argv[1] : "";
    char line[4096];
    double p[@V@], out[@MOST@];
    const char *names = NULL;
@SETTINGS@@NAMES@    if (!names || !fgets(line, sizeof line, stdin)) return 2;
    puts(names);
    while (fgets(line, sizeof line, stdin)) {
        char *at = line;
        const double *x = p;
        int count = 0;
        for (int i = 0; i < @V@; ++i) p[i] = strtod(at, &at);
@CALLS@        for (int i = 0; i < count; ++i) printf(i + 1 < count ? "%.17g " : "%.17g\n", out[i]);
    }
    return 0;
}
