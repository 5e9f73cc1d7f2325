pure function error_@F@_@NORM@(x, weights@T@, values) &
    result(out)
    real(dp), intent(in) :: x(:, :), weights(:)@TIME@, values(@COLONS@:)
    real(dp) :: out, difference(@N@)
    integer :: k
    out = 0.0_dp
    do k = 1, size(weights)
        difference = [abs(values(@COLONS@k) - @EXACT@(x(:, k)@T@))]
        @ADD@
    end do
    out = @ROOT@
end function error_@F@_@NORM@

