function out = @NAME@(x@T@)
  y = x;
  out = 0;
  [points, weights] = rule();
  for k = 0:@POINTS@*@PANELS@ - 1
    y(@AXIS1@, :) = @LOW@ + @WIDTH@*(floor(k/@POINTS@) + points(mod(k, @POINTS@) + 1));
@BODY@    out = out + @WIDTH@*weights(mod(k, @POINTS@) + 1)*@VALUE@;
  end
end

