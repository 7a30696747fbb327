#include "run_warnings.hpp"

#include "failure.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

namespace lamella::app {

std::string ask_info(const std::string& path) {
    return path == "-" ? "" : fmt::format("; see lamella info {}", path);
}

std::vector<std::string> run_warnings(const FileJob& job, const FileResult& result) {
    std::vector<std::string> warnings;
    const auto add = [&](const std::string& name, const std::string& text) {
        warnings.push_back(with_options(fmt::format("{}: {}", name, text)));
    };
    for (const PlateFile& file : result.files)
        for (const std::string& warning : file.warnings)
            add(input_name(file.path), warning);
    const std::string& first = job.inputs.front().path;
    for (const std::string& doubt : result.doubts.texts())
        add(input_name(first), doubt + ask_info(first));
    for (std::size_t file = 0; file < result.files.size(); ++file)
        if (const std::string text = result.near_faces[file].text(result.report.layers); !text.empty())
            add(input_name(result.files[file].path), text);
    if (!job.shard && result.changes) // others may have some
        if (const std::string nothing =
                nothing_left(result.report.layers, result.report.contours, *result.changes);
            !nothing.empty())
            add(input_name(first), nothing);
    if (result.unreached.layers > 0)
        add(input_name(first), result.unreached.text());
    for (const std::string& warning : result.warnings)
        add(output_name(job.output), warning);
    for (const std::string& warning : result.report_warnings)
        add(output_name(job.report.path), warning);
    return warnings;
}

} // namespace lamella::app
