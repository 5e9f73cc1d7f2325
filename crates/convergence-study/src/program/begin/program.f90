! NAME.f90: -u'' = pi^2 sin(pi x) on (0, 1) with u(0) = u(1) = 0, by central differences on N cells.
! What it prints is its answer: an error against the exact solution sin(pi x), and a value, by name.
program solver
  implicit none
  integer, parameter :: dp = kind(1.0d0)
  real(dp), parameter :: pi = acos(-1.0_dp)
  real(dp), allocatable :: u(:), ratio(:), right(:)
  real(dp) :: h, pivot
  integer :: n, i
  character(len=32) :: argument

  call get_command_argument(1, argument)
  read (argument, *) n
  h = 1.0_dp / n
  allocate (u(0:n), ratio(0:n), right(0:n), source=0.0_dp)
  ! Elimination for -u(i-1) + 2 u(i) - u(i+1) = h^2 f(i).
  do i = 1, n - 1
    pivot = 2 - ratio(i - 1)
    ratio(i) = 1 / pivot
    right(i) = (h**2 * pi**2 * sin(pi * i * h) + right(i - 1)) / pivot
  end do
  do i = n - 1, 1, -1
    u(i) = right(i) + ratio(i) * u(i + 1)
  end do
  write (*, '(a, es24.16)') 'max = ', maxval([(abs(u(i) - sin(pi * i * h)), i = 0, n)])
  write (*, '(a, es24.16)') 'middle = ', u(n / 2)
end program solver
