int @P@set_parameter(const char *name, double value)
{
@READY@@BODY@    return 1;
}

