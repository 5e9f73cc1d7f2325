program @NAME@_answer
    use @NAME@
    implicit none
    integer, parameter :: double = kind(1.0d0)
    character(4096) :: text, face
    real(double) :: p(@V@), x(@D@)@REAL@
    integer :: status@WHOLE@
@CHOOSE@    call get_command_argument(1, face)
@SETTINGS@    read(*, '(a)', iostat=status) text
    select case (trim(face))
@NAMES@    case default
        stop 2
    end select
    do
        read(*, '(a)', iostat=status) text
        if (status /= 0) exit
        read(text, *) p
        x = p(1:@D@)
@TIME@        select case (trim(face))
@CALLS@        end select
    end do
end program @NAME@_answer
