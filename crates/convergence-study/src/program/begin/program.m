% NAME.m N: -u'' = pi^2 sin(pi x) on (0, 1) with u(0) = u(1) = 0, by central differences on N cells.
% What it prints is its answer: an error against the exact solution sin(pi x), and a value, by name.
n = str2double(argv(){end});
h = 1 / n;
x = (1:n-1)' * h;
e = ones(n - 1, 1);
A = spdiags([-e, 2 * e, -e], -1:1, n - 1, n - 1) / h^2;
u = A \ (pi^2 * sin(pi * x));
printf("max = %.16e\n", max(abs(u - sin(pi * x))));
printf("middle = %.16e\n", u(n / 2));
