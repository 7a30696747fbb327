#pragma once

// The parts of the experiments, as binary STL files in a temporary folder.

#include "experiment.hpp"

#include <lamella/jobs.hpp>

#include <string>
#include <vector>

namespace lamella::bench {

struct Part {
    std::string name;
    std::string path;
    double layer_height = 0.1;
};

/// Returns sheet 1225, its shuffled twin, sheet 100 on its edge, rook and lattice (about 900,000 triangles).
/// Makes the files on the first call, and reuses existing ones.
[[nodiscard]] std::vector<Part> standard_parts();

/// Returns the standard parts named by the option --parts, with hyphens for blanks. Exits the program with a
/// message if there is none.
[[nodiscard]] std::vector<Part> chosen_parts(const Options& options);

/// An opened part, with the plan for all measurements.
struct OpenedPart {
    Mesh mesh;
    Box3 box;
    Plan plan;
};
[[nodiscard]] OpenedPart open_part(const Part& part, const Execution& execution);

/// Returns the seconds from the file to all layers in memory.
[[nodiscard]] double seconds_into_memory(const Part& part, unsigned threads);

/// Writes a part unless its file exists.
[[nodiscard]] Part make_part(const std::string& name, double layer_height,
                             const std::function<TriangleSoup()>& make);

} // namespace lamella::bench
