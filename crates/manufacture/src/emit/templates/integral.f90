pure function @NAME@(x@T@) result(out)
    real(dp), intent(in) :: x(:)@TIME@
    real(dp) :: out, y(@D@)
    integer :: k
@DECLARED@@UNUSED@    y = x(1:@D@)
    out = 0.0_dp
    do k = 0, @POINTS@*@PANELS@ - 1
        y(@AXIS1@) = @LOW@ + @WIDTH@*(k/@POINTS@ + rule_x(mod(k, @POINTS@) + 1))
@BODY@        out = out + @WIDTH@*rule_w(mod(k, @POINTS@) + 1)*@VALUE@
    end do
end function @NAME@

