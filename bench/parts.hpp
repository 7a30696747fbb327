#pragma once

// The parts that the experiments slice, as binary STL files in a folder of the system's temporary files.

#include "experiment.hpp"

#include <lamella/lamella.hpp>

#include <string>
#include <vector>

namespace lamella::bench {

struct Part {
    std::string name;
    std::string path;
    double layer_height = 0.1;
};

/// sheet 1225, its shuffled twin, sheet 100 on its edge, rook and lattice (about 900,000 triangles). Made on
/// the first call, reused as long as the files are there.
[[nodiscard]] std::vector<Part> standard_parts();

/// Those of them that the option --parts names, blanks as hyphens. Exits the program with a
/// message when there is none.
[[nodiscard]] std::vector<Part> chosen_parts(const Options& options);

/// A part as an experiment slices it: one plan for all measurements.
struct OpenedPart {
    Mesh mesh;
    Box3 box;
    Plan plan;
};
[[nodiscard]] OpenedPart open_part(const Part& part, const Execution& execution);

/// How long it takes from the file to all layers in memory.
[[nodiscard]] double seconds_into_memory(const Part& part, unsigned threads);

/// Writes a part unless its file is already there.
[[nodiscard]] Part make_part(const std::string& name, double layer_height,
                             const std::function<TriangleSoup()>& make);

} // namespace lamella::bench
