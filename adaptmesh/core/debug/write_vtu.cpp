#include "adaptmesh/core/debug/write_vtu.hpp"

#include <fstream>
#include <limits>
#include <ostream>
#include <vector>

namespace adaptmesh {

namespace {

template <typename Values>
void array(std::ostream& out, const char* type, const char* name, int components, Values values) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << components << "\" format=\"ascii\">\n";
    values();
    out << "</DataArray>\n";
}

}  // namespace

void write_vtu(const MetricMesh& mesh, std::ostream& out) {
    std::vector<Index> living;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (!mesh.topology.is_dead(t)) living.push_back(t);
    }
    const auto for_vertices = [&](auto write) {
        return [&, write] {
            for (const Vertex& v : mesh.vertices) write(v), out << '\n';
        };
    };
    const auto for_triangles = [&](auto write) {
        return [&, write] {
            for (Index t : living) write(t), out << '\n';
        };
    };
    out.precision(std::numeric_limits<double>::max_digits10);
    out << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid>\n"
        << "<Piece NumberOfPoints=\"" << mesh.vertices.size() << "\" NumberOfCells=\""
        << living.size() << "\">\n<Points>\n";
    array(out, "Float64", "Points", 3,
          for_vertices([&](const Vertex& v) { out << v.at.x << ' ' << v.at.y << " 0"; }));
    out << "</Points>\n<Cells>\n";
    array(out, "Int32", "connectivity", 1, for_triangles([&](Index t) {
              const Triangle& T = mesh.triangle(t);
              out << T.v[0] << ' ' << T.v[1] << ' ' << T.v[2];
          }));
    Index end = 0;
    array(out, "Int32", "offsets", 1, [&] {
        for (std::size_t i = 0; i < living.size(); ++i) out << (end += 3) << '\n';
    });
    array(out, "UInt8", "types", 1, for_triangles([&](Index) { out << 5; }));
    out << "</Cells>\n<PointData>\n";
    Index number = 0;
    array(out, "Int32", "number", 1, for_vertices([&](const Vertex&) { out << number++; }));
    array(out, "Float64", "metric", 3, for_vertices([&](const Vertex& v) {
              out << v.metric.a << ' ' << v.metric.b << ' ' << v.metric.c;
          }));
    array(out, "Int32", "held_by", 1, for_vertices([&](const Vertex& v) { out << v.held_by; }));
    out << "</PointData>\n<CellData>\n";
    array(out, "Int32", "triangle", 1, for_triangles([&](Index t) { out << t; }));
    array(out, "Int32", "label", 1, for_triangles([&](Index t) { out << mesh.triangle(t).label; }));
    array(out, "Int32", "pending", 1,
          for_triangles([&](Index t) { out << mesh.triangle(t).pending; }));
    array(out, "Float64", "quality", 1, for_triangles([&](Index t) { out << mesh.quality(t); }));
    out << "</CellData>\n</Piece></UnstructuredGrid></VTKFile>\n";
}

void write_vtu(const MetricMesh& mesh, const char* path) {
    std::ofstream out(path);
    write_vtu(mesh, out);
}

}  // namespace adaptmesh
