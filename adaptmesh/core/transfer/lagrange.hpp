// Lagrange polynomials on a triangle, of degree 0, 1 and 2.
#pragma once

#include <algorithm>

namespace adaptmesh {

// The Lagrange basis of degree 0, 1, 2 at barycentric coordinates: the vertices, then the midpoint
// of the edge opposite each. `AT` is where the nodes are. `RULE` integrates products of two of them
// exactly on a triangle: barycentric coordinates, and weights that add up to 1. A polynomial with
// values at the nodes lies between its least and its largest control value, those of Bernstein.
struct RulePoint {
    double at[3], weight;
};

struct Constant {
    static constexpr int NODES = 1;
    static void basis(const double*, double* out) { out[0] = 1; }
    static constexpr RulePoint RULE[] = {{{1. / 3, 1. / 3, 1. / 3}, 1}};
    static constexpr double AT[1][3] = {{1. / 3, 1. / 3, 1. / 3}};
    static void control_values(const double* nodal, double* out) { out[0] = nodal[0]; }
};

struct Linear {
    static constexpr int NODES = 3;
    static void basis(const double* l, double* out) {
        for (int i = 0; i < 3; ++i) out[i] = l[i];
    }
    static constexpr RulePoint RULE[] = {
        {{0, 0.5, 0.5}, 1. / 3}, {{0.5, 0, 0.5}, 1. / 3}, {{0.5, 0.5, 0}, 1. / 3}};
    static constexpr double AT[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static void control_values(const double* nodal, double* out) {
        std::copy(nodal, nodal + 3, out);
    }
};

struct Quadratic {
    static constexpr int NODES = 6;
    static void basis(const double* l, double* out) {
        for (int i = 0; i < 3; ++i) out[i] = l[i] * (2 * l[i] - 1);
        out[3] = 4 * l[1] * l[2], out[4] = 4 * l[2] * l[0], out[5] = 4 * l[0] * l[1];
    }
    // Degree 4, six points (Dunavant, International Journal for Numerical Methods in Engineering
    // 21, 1985).
    static constexpr double A = 0.44594849091596488632, B = 0.09157621350977074346;
    static constexpr double U = 0.22338158967801146570, V = 0.10995174365532186764;
    static constexpr RulePoint RULE[] = {{{1 - 2 * A, A, A}, U}, {{A, 1 - 2 * A, A}, U},
                                         {{A, A, 1 - 2 * A}, U}, {{1 - 2 * B, B, B}, V},
                                         {{B, 1 - 2 * B, B}, V}, {{B, B, 1 - 2 * B}, V}};
    static constexpr double AT[6][3] = {{1, 0, 0},     {0, 1, 0},     {0, 0, 1},
                                        {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
    static void control_values(const double* nodal, double* out) {
        std::copy(nodal, nodal + 3, out);
        for (int i = 0; i < 3; ++i) {
            out[3 + i] = 2 * nodal[3 + i] - 0.5 * (nodal[(i + 1) % 3] + nodal[(i + 2) % 3]);
        }
    }
};

}  // namespace adaptmesh
