! Numerov's scheme for y'' = -y on (0, 4), with the solution sin(x): the value at x = 4.
program numerov
    implicit none
    integer, parameter :: real64 = selected_real_kind(15)
    integer :: n, i
    real(real64) :: h, before, now, next
    character(len=20) :: word
    call get_command_argument(1, word)
    read (word, *) n
    h = 4.0_real64 / n
    before = 0
    now = sin(h)
    do i = 2, n
        next = (2 * (1 - 5 * h**2 / 12) * now - (1 + h**2 / 12) * before) / (1 + h**2 / 12)
        before = now
        now = next
    end do
    ! For the harness:
    print '(a, es23.16, a, es23.16, a)', '{"errors": {"end": ', abs(now - sin(4.0_real64)), '}, "h": ', h, '}'
end program
