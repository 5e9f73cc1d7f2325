function chosen = variant()
  % The number of the variant that the environment variable MANUFACTURE_VARIANT names; 0 is the
  % solution of the file.
  persistent known
  if isempty(known)
    names = {'', ...
      @LIST@};
    name = getenv('MANUFACTURE_VARIANT');
    known = find(strcmp(name, names)) - 1;
    if isempty(known)
      error('MANUFACTURE_VARIANT: unknown variant `%s`; expected one of%s', name, sprintf(' %s', names{2:end}));
    end
  end
  chosen = known;
end

