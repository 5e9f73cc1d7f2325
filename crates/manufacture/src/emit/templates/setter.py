def set_parameter(name, value):
@GLOBALS@@BODY@

