#include "adaptmesh/core/transfer/overlap.hpp"

#include <cmath>

#include "adaptmesh/core/geometry/accurate_area.hpp"
#include "adaptmesh/core/geometry/point.hpp"

namespace adaptmesh {

double Overlap::area() const {
    double sum = 0;
    for_each_triangle([&](double area, auto&...) { sum += area; });
    return sum;
}

void Overlap::weigh(const Triangle3& triangle, Point p, double weights[3]) {
    const double whole = 2 * triangle.area;
    for (int i = 0; i < 3; ++i) {
        const Point a = triangle.at[after(i)], b = triangle.at[after(after(i))];
        weights[i] = twice_area(a, b, p) / whole;
    }
}

bool Overlap::is_shifted_left(Point a, Point b, int shift) {
    if (a.y != b.y) return (a.y > b.y) == (shift > 0);
    return (b.x > a.x) == (shift > 0);
}

void Overlap::find_sides(const Triangle3& of, const Triangle3& corners, int shift, int edge,
                         Sides& sides) {
    const Point a = of.at[after(edge)], b = of.at[after(after(edge))];
    for (int j = 0; j < 3; ++j) {
        RoundedArea area = rounded_twice_area(a, b, corners.at[j]);
        if (!area.has_sign()) {
            area.value = twice_area(a, b, corners.at[j]);
            area.magnitude = std::fabs(area.value);
        }
        sides.area[edge][j] = area;
        sides.in[edge][j] = area.value != 0 ? area.value > 0 : is_shifted_left(a, b, shift);
    }
}

bool Overlap::is_apart() {
    for (int i = 0; i < 3; ++i) {
        find_sides(old_, new_, +1, i, new_sides_);
        if (new_sides_.all_out(i)) return true;
        find_sides(new_, old_, -1, i, old_sides_);
        if (old_sides_.all_out(i)) return true;
    }
    return false;
}

void Overlap::find_portions() {
    for (int i = 0; i < 3; ++i) {
        old_edge_inside_[i] = add_portion(
            i, old_sides_, new_sides_, [&](int v) { return old_corner(v); },
            [&](int j) { return crossing(i, j); });
    }
    for (int j = 0; j < 3; ++j) {
        add_portion(
            j, new_sides_, old_sides_, [&](int v) { return new_corner(v); },
            [&](int i) { return crossing(i, j); });
    }
}

Corner Overlap::old_corner(int v) const {
    Corner out{{0, 0, 0}, {}};
    out.in_old[v] = 1;
    weigh_inside(new_, old_.at[v], old_sides_, v, out.in_new);
    return out;
}

Corner Overlap::new_corner(int v) const {
    Corner out{{}, {0, 0, 0}};
    out.in_new[v] = 1;
    weigh_inside(old_, new_.at[v], new_sides_, v, out.in_old);
    return out;
}

void Overlap::weigh_inside(const Triangle3& triangle, Point p, const Sides& sides, int v,
                           double weights[3]) {
    double sum = 0, magnitude = 0;
    for (int i = 0; i < 3; ++i) {
        sum += weights[i] = std::fmax(sides.area[i][v].value, 0.0);
        magnitude += sides.area[i][v].magnitude;
    }
    if (!is_accurate(magnitude, sum)) {
        weigh(triangle, p, weights);
        sum = weights[0] + weights[1] + weights[2];
    }
    for (int i = 0; i < 3; ++i) weights[i] /= sum;
}

Corner Overlap::crossing(int old_edge, int new_edge) const {
    Corner out{{0, 0, 0}, {0, 0, 0}};
    cut(old_, old_edge, new_, new_edge, old_sides_, out.in_old);
    cut(new_, new_edge, old_, old_edge, new_sides_, out.in_new);
    return out;
}

void Overlap::cut(const Triangle3& triangle, int edge, const Triangle3& other, int across,
                  const Sides& sides, double weights[3]) {
    const int a = after(edge), b = after(a);
    const RoundedArea &from_a = sides.area[across][a], &from_b = sides.area[across][b];
    double at_a = std::fabs(from_a.value), at_b = std::fabs(from_b.value);
    if (!is_accurate(from_a.magnitude + from_b.magnitude, at_a + at_b)) {
        const Point p = other.at[after(across)], q = other.at[after(after(across))];
        at_a = std::fabs(twice_area(p, q, triangle.at[a]));
        at_b = std::fabs(twice_area(p, q, triangle.at[b]));
    }
    weights[a] = at_b / (at_a + at_b);
    weights[b] = at_a / (at_a + at_b);
}

}  // namespace adaptmesh
