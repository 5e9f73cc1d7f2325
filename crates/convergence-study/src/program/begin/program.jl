# NAME.jl N: -u'' = pi^2 sin(pi x) on (0, 1) with u(0) = u(1) = 0, by central differences on N cells.
# What it prints is its answer: an error against the exact solution sin(pi x), and a value, by name.
using LinearAlgebra

n = parse(Int, ARGS[1])
h = 1 / n
x = (1:n-1) .* h
u = SymTridiagonal(fill(2.0, n - 1), fill(-1.0, n - 2)) \ (h^2 .* pi^2 .* sin.(pi .* x))
println("max = ", maximum(abs.(u .- sin.(pi .* x))))
println("middle = ", u[n÷2])
