function out = pick(condition, a, b)
  % a where the condition holds, b elsewhere; neither is multiplied, so that NaN stays where it is.
  out = b + zeros(size(condition));
  a = a + zeros(size(condition));
  condition = condition & true(size(out));
  if isscalar(a), a = a*ones(size(out)); end
  if isscalar(out), out = out*ones(size(a)); end
  out(condition) = a(condition);
end

