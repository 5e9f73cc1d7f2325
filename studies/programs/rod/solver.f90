! Heat in a rod by finite volumes: n cells, n steps of the trapezoidal rule. Source, data and exact
! values come from the module that `convergence-study manufacture rod.toml` writes.
program solver
    use rod
    implicit none
    integer, parameter :: dp = kind(1.0d0)
    real(dp), allocatable :: T(:), b(:), c(:), below(:), at(:), above(:), x(:)
    real(dp) :: h, dt, pivot
    integer :: n, i, k
    character(32) :: word

    call choose_variant()
    call get_command_argument(1, word)
    read(word, *) n
    h = 2.0_dp/n
    dt = 1.0_dp/n
    x = [((i - 0.5_dp)*h, i = 1, n)]
    below = [(conductivity((i - 1)*h)/h**2, i = 1, n)]
    above = [(conductivity(i*h)/h**2, i = 1, n)]
    at = -below - above
    ! The slope at x_min by the first two cells and the value there.
    at(1) = -above(1) - below(1)*3
    above(1) = above(1) + below(1)/3
    at(n) = -below(n)
    T = [(initial_T([x(i)]), i = 1, n)]
    allocate(b(n), c(n))
    do k = 0, n - 1
        b = T + dt/2*(rate(T, k*dt) + given((k + 1)*dt))
        ! Elimination, then substitution.
        do i = 1, n
            pivot = 1 - dt/2*at(i)
            if (i > 1) then
                pivot = pivot + dt/2*below(i)*c(i - 1)
                b(i) = b(i) + dt/2*below(i)*b(i - 1)
            end if
            c(i) = -dt/2*above(i)/pivot
            b(i) = b(i)/pivot
        end do
        T(n) = b(n)
        do i = n - 1, 1, -1
            T(i) = b(i) - c(i)*T(i + 1)
        end do
    end do
    print '(a, es23.15)', 'L2 = ', sqrt(h*sum((T - [(exact_T([x(i)], 1.0_dp), i = 1, n)])**2))

contains

    pure function conductivity(place) result(out)
        real(dp), intent(in) :: place
        real(dp) :: out
        out = parameter_k*(1 + place/4)
    end function conductivity

    ! The rate of change of the cells.
    function rate(T, time) result(out)
        real(dp), intent(in) :: T(:), time
        real(dp) :: out(size(T))
        out = at*T + given(time)
        out(2:) = out(2:) + below(2:)*T(:n - 1)
        out(:n - 1) = out(:n - 1) + above(:n - 1)*T(2:)
    end function rate

    ! What does not depend on the cells: source and data.
    function given(time) result(out)
        real(dp), intent(in) :: time
        real(dp) :: out(n)
        out = [(source_T([x(i)], time), i = 1, n)]
        out(1) = out(1) + below(1)*8/3*boundary_x_min_value([0.0_dp], time)
        out(n) = out(n) + boundary_x_max_flux([2.0_dp], time)/h
    end function given
end program solver
