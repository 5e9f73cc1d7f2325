// -div((1 + x y) grad u) + u = f on the unit square by elements of degree 2 of deal.II. The source f and the solution u are written by
// convergence-study manufacture diffusion.toml --language c --out .
#include <deal.II/base/convergence_table.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/numerics/matrix_tools.h>
#include <deal.II/numerics/vector_tools.h>
#include <iostream>
#include "diffusion.h"
using namespace dealii;

struct Exact : Function<2> {
    double value(const Point<2>& x, unsigned int) const override { return diffusion_exact_u(&x[0]); }
    Tensor<1, 2> gradient(const Point<2>& x, unsigned int) const override {
        Tensor<1, 2> slopes;
        diffusion_gradient_u(&x[0], &slopes[0]);
        return slopes;
    }
};

Vector<double> solve(const DoFHandler<2>& dofs) {
    SparsityPattern sparsity(dofs.n_dofs(), dofs.n_dofs(), dofs.max_couplings_between_dofs());
    DoFTools::make_sparsity_pattern(dofs, sparsity);
    sparsity.compress();
    SparseMatrix<double> matrix(sparsity);
    Vector<double> load(dofs.n_dofs()), u(dofs.n_dofs());
    const ScalarFunctionFromFunctionObject<2> source([](const Point<2>& x) { return diffusion_source_balance(&x[0]); });
    const ScalarFunctionFromFunctionObject<2> conductivity([](const Point<2>& x) { return 1 + x[0] * x[1]; });
    MatrixCreator::create_laplace_matrix(dofs, QGauss<2>(3), matrix, &conductivity);
    MatrixCreator::create_mass_matrix(dofs, QGauss<2>(3), matrix);
    VectorTools::create_right_hand_side(dofs, QGauss<2>(3), source, load);
    std::map<types::global_dof_index, double> edge;
    VectorTools::interpolate_boundary_values(dofs, 0, Exact(), edge);
    MatrixTools::apply_boundary_values(edge, matrix, u, load);
    SparseDirectUMFPACK().solve(matrix, load);
    return load;
}

int main() {
    Triangulation<2> mesh;
    GridGenerator::subdivided_hyper_cube(mesh, 4);
    const std::vector<std::pair<std::string, VectorTools::NormType>> norms = {{"L2", VectorTools::L2_norm}, {"H1", VectorTools::H1_seminorm}};
    ConvergenceTable table;
    for (int level = 0; level < 5; level++, mesh.refine_global()) {
        DoFHandler<2> dofs(mesh);
        dofs.distribute_dofs(FE_Q<2>(2));
        const Vector<double> u = solve(dofs);
        table.add_value("cells", mesh.n_active_cells());
        for (const auto& [name, norm] : norms) {
            Vector<double> errors(mesh.n_active_cells());
            VectorTools::integrate_difference(dofs, u, Exact(), errors, QGauss<2>(5), norm);
            table.add_value(name, errors.l2_norm());
        }
    }
    for (const auto& [name, norm] : norms) {
        table.set_scientific(name, true);
        table.evaluate_convergence_rates(name, ConvergenceTable::reduction_rate_log2);
    }
    table.write_text(std::cout);
}
