#include "jobs/plate_names.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

namespace {

std::string and_more(const std::string& first, std::size_t files) {
    return files > 1 ? fmt::format("{} and {}", first, counted(files - 1, "more file")) : first;
}

std::string with_label(const std::string& path, const std::string& label) {
    return fmt::format("{}, part \"{}\"", path, label);
}

} // namespace

std::string name_of(std::span<const PlateInput> inputs) {
    return and_more(inputs.front().path, inputs.size());
}

std::string name_of(const Plate& plate) {
    return and_more(plate.files.front().path, plate.files.size());
}

std::string name_of_part(const Plate& plate, std::size_t part) {
    const std::size_t file = plate.shapes[plate.parts[part].shape].input;
    const auto parts = std::count_if(plate.parts.begin(), plate.parts.end(), [&](const PlatePart& one) {
        return plate.shapes[one.shape].input == file;
    });
    const std::string& path = plate.files[file].path;
    return parts > 1 ? with_label(path, plate.parts[part].label) : path;
}

std::vector<std::string> names_of_parts(const Plate& plate) {
    std::vector<std::size_t> parts(plate.files.size()); // of each file
    for (const PlatePart& part : plate.parts)
        ++parts[plate.shapes[part.shape].input];
    std::vector<std::string> names;
    names.reserve(plate.parts.size());
    for (const PlatePart& part : plate.parts) {
        const std::size_t file = plate.shapes[part.shape].input;
        const std::string& path = plate.files[file].path;
        names.push_back(parts[file] > 1 ? with_label(path, part.label) : path);
    }
    return names;
}

std::string name_of_shape(const Plate& plate, std::size_t shape) {
    const std::size_t file = plate.shapes[shape].input;
    const auto shapes = std::count_if(plate.shapes.begin(), plate.shapes.end(),
                                      [&](const PlateShape& one) { return one.input == file; });
    const auto part = std::find_if(plate.parts.begin(), plate.parts.end(),
                                   [&](const PlatePart& one) { return one.shape == shape; });
    const std::string& path = plate.files[file].path;
    return shapes > 1 && part != plate.parts.end() ? with_label(path, part->label) : path;
}

} // namespace lamella
