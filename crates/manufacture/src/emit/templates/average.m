function out = average_@F@(lo, hi@T@)
  out = 0;
  [points, weights] = gauss();
  for k = 0:@CELLS@ - 1
    rest = k;
    weight = 1;
    x = zeros(@D@, 1);
    for i = 1:@D@
      x(i) = lo(i) + (hi(i) - lo(i))*points(mod(rest, 8) + 1);
      weight = weight*weights(mod(rest, 8) + 1);
      rest = floor(rest/8);
    end
    out = out + weight*exact_@F@(x@T@);
  end
end

