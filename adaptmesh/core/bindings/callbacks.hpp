// Functions of Python that the core calls: the metric, interruption and progress.
#pragma once

#include <chrono>
#include <utility>
#include <vector>

#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/monitor.hpp"

// A metric of Python: a function of an (n, 2) array that returns (n, 3) packed metrics, which have
// been checked. The core works without the GIL; what the function raises goes through it.
inline adaptmesh::MetricField metric_of(const nb::callable& function) {
    return [&function](const std::vector<adaptmesh::Point>& points,
                       std::vector<metrics::Tensor>& tensors) {
        nb::gil_scoped_acquire gil;
        const auto answer = nb::cast<Tensors>(function(rows(points)));
        expect_rows(answer.shape(0), points.size(), "metrics at points");
        tensors = to_tensors(answer);
    };
}

// Lets Ctrl-C through, and tells a function of Python how far the work is.
class PythonMonitor : public adaptmesh::Monitor {
  public:
    PythonMonitor() = default;
    PythonMonitor(adaptmesh::Index max_vertices, adaptmesh::Index expected_vertices,
                  nb::callable progress)
        : Monitor(max_vertices, expected_vertices), progress_(std::move(progress)) {}

    void report(const char* stage, double fraction) override {
        nb::gil_scoped_acquire gil;
        if (progress_.is_valid()) progress_(stage, fraction);
    }

  protected:
    void stop_if_asked() override {
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(100)) return;
        last_ = now;
        nb::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }

  private:
    nb::callable progress_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};
