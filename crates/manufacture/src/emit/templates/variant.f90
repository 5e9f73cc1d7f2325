! Chooses the variant that the environment variable MANUFACTURE_VARIANT names.
subroutine choose_variant()
    use, intrinsic :: iso_fortran_env, only: error_unit
    character(*), parameter :: names(0:@LAST@) = [character(@LONGEST@) :: '', &
        @LIST@]
    character(4096) :: name
    integer :: place, known
    if (variant >= 0) return
    call get_environment_variable('MANUFACTURE_VARIANT', name)
    do place = 0, @LAST@
        if (name == names(place)) exit
    end do
    if (place > @LAST@) then
        write(error_unit, '(*(a))') 'MANUFACTURE_VARIANT: unknown variant `', trim(name), &
            '`; expected one of', (' ', trim(names(known)), known = 1, @LAST@)
        error stop 2
    end if
@CHANGES@    variant = place
end subroutine choose_variant

! Ends a program that has not called choose_variant. A pure procedure cannot write or stop before
! Fortran 2018: an array that is not there has a name that says what to do.
pure subroutine require_variant()
    integer, allocatable :: call_choose_variant_first
    if (variant < 0) deallocate(call_choose_variant_first)
end subroutine require_variant

