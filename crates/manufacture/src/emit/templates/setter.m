function set_parameter(name, value)
@BODY@end

