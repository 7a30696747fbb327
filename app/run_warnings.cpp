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
    for (const Finding& finding : result.findings.by_file) {
        if (finding.file == Finding::all_files) {
            add(inputs_name(job.inputs), finding.text());
            continue;
        }
        const std::string& path = result.files[finding.file].path;
        const bool of_mesh = description(finding.kind).origin == FindingOrigin::mesh;
        add(input_name(path), finding.text() + (of_mesh ? ask_info(path) : std::string()));
    }
    for (const std::string& text : result.losses.texts())
        add(output_name(job.output), text);
    for (const std::string& text : result.report_losses.texts())
        add(output_name(job.report.path), text);
    return warnings;
}

} // namespace lamella::app
