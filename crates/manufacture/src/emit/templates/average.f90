pure function average_@F@(lo, hi@T@) result(out)
    real(dp), intent(in) :: lo(:), hi(:)@TIME@
    real(dp) :: out@SHAPE@, x(@D@), weight
    integer :: k, i, rest
    out = 0.0_dp
    do k = 0, @CELLS@ - 1
        weight = 1.0_dp
        rest = k
        do i = 1, @D@
            x(i) = lo(i) + (hi(i) - lo(i))*gauss_x(mod(rest, 8) + 1)
            weight = weight*gauss_w(mod(rest, 8) + 1)
            rest = rest/8
        end do
        out = out + weight*exact_@F@(x@T@)
    end do
end function average_@F@

