subroutine set_parameter(name, value)
    character(*), intent(in) :: name
    real(dp), intent(in) :: value
@DECLARED@@READY@@BODY@end subroutine set_parameter

