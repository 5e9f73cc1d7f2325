function out = error_@F@_@NORM@(x, weights@T@, values)
  difference = abs(values - @EXACT@(x@T@));
  out = @ROOT@;
end

