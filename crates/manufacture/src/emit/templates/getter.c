double @P@get_parameter(const char *name)
{
@CASES@    return NAN;
}

