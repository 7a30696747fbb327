#include "parts.hpp"

#include "parts/shapes.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace lamella::bench {

Part make_part(const std::string& name, double layer_height, const std::function<TriangleSoup()>& make) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "lamella-bench";
    std::filesystem::create_directories(folder);
    std::string file = name + ".stl";
    std::replace(file.begin(), file.end(), ' ', '-');
    const std::string path = (folder / file).string();
    if (!std::filesystem::exists(path))
        write_stl(path, make());
    return {name, path, layer_height};
}

std::vector<Part> standard_parts() {
    const auto sheet = [](unsigned holes) {
        return make_sheet({.holes = holes});
    };
    return {
        make_part("sheet 1225", 0.1, [&] { return sheet(1225); }),
        make_part("sheet 1225 shuffled", 0.1, [&] { return shuffled(sheet(1225), 1); }),
        make_part("sheet 100 on edge", 0.1, [&] { return sheet(100).transformed(rotation('x', 90)); }),
        make_part("rook", 0.1, [] { return make_rook(); }),
        make_part("lattice", 0.1, [] { return make_lattice({}); }),
    };
}

std::vector<Part> chosen_parts(const Options& options) {
    std::vector<Part> parts = standard_parts();
    const std::vector<std::string> names = options.list("--parts");
    std::erase_if(parts, [&](const Part& part) {
        std::string name = part.name;
        std::replace(name.begin(), name.end(), ' ', '-');
        return std::find(names.begin(), names.end(), name) == names.end();
    });
    if (parts.empty()) {
        std::cerr << "--parts names none of the standard parts\n";
        std::exit(2);
    }
    return parts;
}

OpenedPart open_part(const Part& part, const Execution& execution) {
    OpenedPart opened{read_mesh(part.path, {}, execution).mesh(), {}, {}};
    opened.box = bounding_box(opened.mesh, execution);
    opened.plan = plan_uniform(opened.box.min.z, opened.box.max.z, {.layer_height = part.layer_height});
    return opened;
}

double seconds_into_memory(const Part& part, unsigned threads) {
    const auto start = Clock::now();
    const Execution execution{.threads = threads};
    const OpenedPart opened = open_part(part, execution);
    const LayerStack layers = slice(opened.mesh, opened.plan, {.execution = execution});
    return seconds_since(start);
}

} // namespace lamella::bench
