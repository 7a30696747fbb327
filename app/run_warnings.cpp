#include "run_warnings.hpp"

#include "failure.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

namespace lamella::app {

std::string ask_info(const std::string& path) {
    return path == "-" ? "" : fmt::format("; see lamella info {}", path);
}

std::string inputs_name(std::span<const PlateInput> inputs) {
    const std::size_t others = inputs.size() - 1;
    return input_name(inputs.front().path) +
           (others == 0 ? "" : fmt::format(" and {}", counted(others, "more file")));
}

std::vector<std::string> run_warnings(const FileJob& job, const FileResult& result) {
    std::vector<std::string> warnings;
    const auto add = [&](const std::string& name, const std::string& text) {
        warnings.push_back(with_options(fmt::format("{}: {}", name, text)));
    };
    for (const PlateFile& file : result.files)
        for (const std::string& warning : file.warnings)
            add(input_name(file.path), warning);
    for (std::size_t i = 0; i < result.doubts.size(); ++i)
        for (const std::string& doubt : result.doubts[i].texts())
            add(input_name(result.files[i].path), doubt + ask_info(result.files[i].path));
    for (std::size_t file = 0; file < result.files.size(); ++file)
        if (const std::string text = result.near_faces[file].text(result.report.layers); !text.empty())
            add(input_name(result.files[file].path), text);
    if (!job.shard && result.changes) // other shards may have contours
        if (const std::string nothing =
                nothing_left(result.report.layers, result.report.contours, *result.changes);
            !nothing.empty())
            add(inputs_name(job.inputs), nothing);
    for (std::size_t file = 0; file < result.files.size(); ++file)
        if (result.unreached_by_file[file].layers > 0)
            add(input_name(result.files[file].path), result.unreached_by_file[file].text());
    for (const std::string& warning : result.warnings)
        add(output_name(job.output), warning);
    for (const std::string& warning : result.report_warnings)
        add(output_name(job.report.path), warning);
    return warnings;
}

} // namespace lamella::app
