function values = parameters(new)
  persistent known
  if isempty(known)
@LINES@@CHANGES@  end
  if nargin > 0, known = new; end
  values = known;
end

function store(name, value)
  values = parameters();
  values.(name) = value;
  parameters(values);
end

