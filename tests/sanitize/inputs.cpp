// The zoo: degenerate and ordinary inputs.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/sanitize/input.hpp"

namespace sanitize {

namespace {

using Shape = std::vector<Point>;

Shape grid(int nx, int ny, double step) {
    Shape out;
    for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) out.push_back({x * step, y * step});
    }
    return out;
}

Shape circle(int n, double radius) {
    Shape out;
    for (int k = 0; k < n; ++k) {
        const double angle = 2 * 3.141592653589793 * k / n;
        out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return out;
}

Shape random_lattice(int n, int side, unsigned seed) {
    std::mt19937 random(seed);
    Shape out;
    for (int k = 0; k < n; ++k) {
        const double x = random() % side, y = random() % side;
        out.push_back({x, y});
    }
    return out;
}

Shape clusters(int n, double spread) {
    Shape out = random_lattice(n, 4, 1);
    std::mt19937 random(2);
    for (Point& p : out) p.x += spread * (random() % 1000), p.y += spread * (random() % 1000);
    return out;
}

Shape line(int n, Point step, Point extra) {
    Shape out = {extra};
    for (int k = 0; k < n; ++k) out.push_back({k * step.x, k * step.y});
    return out;
}

Shape parabola(int n) {
    Shape out;
    for (int k = -n; k <= n; ++k) out.push_back({double(k), double(k) * k});
    return out;
}

// A closed polygon through the last `count` points of the input.
void close_ring(Input& input, Index count) {
    const Index first = Index(input.points.size()) - count;
    for (Index k = 0; k < count; ++k) {
        input.segments.push_back({first + k, first + (k + 1) % count});
    }
}

void add_ring(Input& input, const Shape& corners) {
    input.points.insert(input.points.end(), corners.begin(), corners.end());
    close_ring(input, Index(corners.size()));
}

// Segments of random lattice points, in a frame: crossing, overlapping, touching, or none of it.
Input random_segments(unsigned seed) {
    std::mt19937 random(seed);
    Input input{"random segments " + std::to_string(seed), {}, {}, {}};
    for (Point p : random_lattice(30, 9, seed)) {
        const auto same = [p](Point q) { return p.x == q.x && p.y == q.y; };
        if (std::none_of(input.points.begin(), input.points.end(), same)) input.points.push_back(p);
    }
    const Index n = Index(input.points.size());
    for (unsigned k = 0; k < seed % 8; ++k) {
        input.segments.push_back({Index(random() % n), Index(random() % n)});
    }
    add_ring(input, {{-1, -1}, {10, -1}, {10, 10}, {-1, 10}});
    input.options.nesting = seed % 2 == 0;
    return input;
}

}  // namespace

std::vector<Input> inputs() {
    std::vector<Input> out = {
        {"nothing", {}, {}, {}},
        {"one point", {{1, 1}}, {}, {}},
        {"one place", Shape(9, {1, 1}), {}, {}},
        {"line", line(40, {1, 1}, {50, 50}), {}, {}},
        {"line and a point", line(60, {1, 0}, {20.3, 4}), {}, {}},
        {"slope and a point", line(60, {0.1, 0.3}, {2, 6.1}), {}, {}},
        {"grid", grid(20, 15, 1), {}, {}},
        {"grid of 0.1", grid(20, 15, 0.1), {}, {}},
        {"circle", circle(200, 1), {}, {}},
        {"lattice with duplicates", random_lattice(400, 12, 3), {}, {}},
        {"clusters", clusters(300, 1e-15), {}, {}},
        {"parabola", parabola(80), {}, {}},
        {"infinite", {{0, 0}, {1, 0}, {0, INFINITY}}, {}, {}},
        {"huge and tiny", {{1e308, -1e308}, {-1e308, 1e308}, {5e-324, 0}, {0, 1e-300}}, {}, {}},
    };
    for (Input& input : std::vector<Input>(out)) {
        if (input.points.size() < 3) continue;
        input.name += ", in a ring";
        add_ring(input, circle(30, 1000));
        out.push_back(input);
    }
    Input framed{"framed grid", grid(12, 9, 1), {{0, 11}, {11, 107}, {107, 96}, {96, 0}}, {}};
    out.push_back(framed);
    Input rings{"nested rings", {}, {}, {{}, {}, true}};
    for (int k = 1; k <= 6; ++k) add_ring(rings, circle(5 * k, k));
    out.push_back(rings);
    rings.name += " with holes and regions";
    rings.options = {{{0, 0}, {0, 2.5}}, {{0, 1.5}, {0, 5.5}}, false};
    out.push_back(rings);
    Input comb{"comb", {{-1, 0}, {101, 0}}, {{0, 1}}, {}};
    for (int k = 0; k < 100; ++k) comb.points.push_back({double(k), k % 2 == 0 ? 0.01 : -0.01});
    add_ring(comb, circle(12, 300));
    out.push_back(comb);
    Input slit{"slit an ulp wide", {}, {}, {}};
    add_ring(slit, {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0.2 + 9e-16}, {1, 0.9234}, {0, 0.2}});
    out.push_back(slit);
    Input touching{"squares that touch", {}, {}, {{}, {}, true}};
    touching.points = grid(4, 4, 1);
    for (Index k : {0, 2, 5, 8, 10}) {
        for (auto [i, j] : {std::pair{0, 1}, {1, 5}, {5, 4}, {4, 0}})
            touching.segments.push_back({k + i, k + j});
    }
    out.push_back(touching);
    for (unsigned seed = 0; seed < 300; ++seed) out.push_back(random_segments(seed));
    return out;
}

}  // namespace sanitize
