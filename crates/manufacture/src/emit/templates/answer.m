1;
p = @NAME@();
face = '';
words = argv();
if numel(words) > 0
  face = words{1};
end
@SETTINGS@columns = numel(strsplit(strtrim(fgetl(stdin)), ' '));
points = fscanf(stdin, '%f', [columns, Inf]);
x = points(1:@D@, :);
@TIME@switch face
@CALLS@end
for k = 1:size(rows, 2)
  printf('%.17g ', rows(:, k));
  printf('\n');
end
