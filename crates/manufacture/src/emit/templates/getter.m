function value = get_parameter(name)
  switch name
@CASES@    otherwise
      error('unknown parameter %s', name);
  end
end

