# The implicit midpoint rule for the pendulum u'' = -sin(u), by its energy, which the exact solution keeps.
# Nobody has run this file here: the machine that checks the others has no Julia.
function drift(n)
    h, u, v = 10 / n, 1.0, 0.0
    energy(u, v) = v^2 / 2 - cos(u)
    largest = 0.0
    for _ in 1:n
        mu, mv = u, v
        for _ in 1:50
            mu, mv = u + h / 2 * mv, v - h / 2 * sin(mu)
        end
        u, v = 2mu - u, 2mv - v
        largest = max(largest, abs(energy(u, v) - energy(1.0, 0.0)))
    end
    return largest
end

# For the harness:
n = parse(Int, ARGS[1])
println("{\"errors\": {\"energy\": $(drift(n))}, \"h\": $(10 / n)}")
