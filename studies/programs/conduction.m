% The heat equation u_t = u_xx on (0, 1) by Crank-Nicolson and central differences, with the solution exp(-pi^2 t) sin(pi x).
function conduction(n)
    h = 1 / n;
    dt = h / 2;
    x = (h:h:1-h/2)';
    e = ones(n - 1, 1);
    A = spdiags([e, -2 * e, e], -1:1, n - 1, n - 1) / h^2;
    I = speye(n - 1);
    theta = 1/2;
    u = sin(pi * x);
    for step = 1:round(0.1 / dt)
        u = (I - theta * dt * A) \ ((I + (1 - theta) * dt * A) * u);
    end
    t = round(0.1 / dt) * dt;
    error = u - exp(-pi^2 * t) * sin(pi * x);
    % For the harness:
    printf('{"errors": {"L2": %.15e, "max": %.15e}}\n', sqrt(h) * norm(error), max(abs(error)));
end
