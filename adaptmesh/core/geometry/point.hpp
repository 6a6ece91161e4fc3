// A point of the plane.
#pragma once

namespace adaptmesh {

struct Point {
    double x, y;
};

}  // namespace adaptmesh
