#pragma once

// Functions that make options, and groups of options that several commands share.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/plan.hpp"

#include "command.hpp"
#include "image_options.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {

// Each option refers to its target, which must outlive the command; the target's value is the default.

[[nodiscard]] Option row(std::string name, ValueKind kind, std::string placeholder, std::string help,
                         std::function<void(const std::string&)> set);
[[nodiscard]] Option flag(std::string name, std::string help, bool& target);
[[nodiscard]] Option count(std::string name, std::string placeholder, std::string help,
                           std::optional<std::uint64_t>& target);
[[nodiscard]] Option length(std::string name, std::string help, std::optional<double>& target);
[[nodiscard]] Option number(std::string name, std::string placeholder, std::string help,
                            std::optional<double>& target);
[[nodiscard]] Option triple(std::string name, std::string placeholder, std::string help,
                            std::optional<std::array<double, 3>>& target);
[[nodiscard]] Option choice(std::string name, std::string placeholder, std::string help,
                            std::vector<std::string> choices, std::string& target);
[[nodiscard]] Option text(std::string name, std::string placeholder, std::string help, std::string& target);
[[nodiscard]] Option input_file(std::string name, std::string help, std::string& target);
/// `extensions`, such as ".html", are those that the file name may have; it may also have none. Any other
/// extension would suggest another format. Help texts mention the first one. If `extensions` is empty, any
/// name is allowed.
[[nodiscard]] Option output_file(std::string name, std::string help, std::string& target,
                                 std::vector<std::string_view> extensions = {});
/// A limit in bytes, such as 500M.
[[nodiscard]] Option byte_limit(std::string name, std::string help, std::optional<std::uint64_t>& target);

/// Placement of the part: unit, scale, rotation, translation, then the slicing direction.
struct PlacementOptions {
    std::string unit = {}; ///< "" if not given
    std::optional<std::vector<double>> scale;
    std::optional<std::array<double, 3>> rotate;
    std::array<std::optional<double>, 3> rotate_axis;
    std::optional<std::array<double, 3>> translate;
    std::optional<std::array<double, 3>> direction;

    /// Returns the millimetres per unit, if a unit is given.
    [[nodiscard]] std::optional<double> unit_mm() const;
    /// Returns the placement without the unit. Throws Error{usage}.
    [[nodiscard]] Transform pose() const;
    [[nodiscard]] bool given() const;
};
/// Returns "mm", "inch"; the millimetres of a unit without a name.
[[nodiscard]] std::string unit_name(double mm);
[[nodiscard]] Option unit_option(std::string& target);
/// Returns the options, followed by `more`.
[[nodiscard]] OptionGroup placement_options(PlacementOptions& target, const std::vector<Option>& more = {});
/// Returns the placement options for generated bodies, without unit and direction.
[[nodiscard]] OptionGroup pose_options(PlacementOptions& target);

/// Options for the execution of the computation and for the style of its messages.
struct RunOptions {
    std::optional<std::uint64_t> threads;
    std::string progress = "bar";
    bool quiet = false;

    /// Returns the execution, and sets the style of the messages.
    [[nodiscard]] Execution execution(const Context& context) const;
};
/// Returns the options, followed by `more`.
[[nodiscard]] OptionGroup run_options(RunOptions& target, const std::vector<Option>& more = {});

/// Content to read from a file, and its limits.
struct ReadLimits {
    MeshRoles include; ///< roles that are read in addition to parts
    std::optional<std::uint64_t> max_triangles;
    std::optional<std::uint64_t> max_memory; ///< bytes

    /// Where memory is limited, lets the process return to the system what it frees. Call it before files are
    /// read: lists that grow would leave gaps.
    void prepare_memory() const noexcept;
    /// `held`: bytes that files read before still take.
    [[nodiscard]] MeshReadOptions of_meshes(std::uint64_t held = 0) const;
    [[nodiscard]] LayerReadOptions of_layers(std::uint64_t held = 0) const;
};
[[nodiscard]] Option include_option(ReadLimits& target);
[[nodiscard]] Option max_triangles_option(ReadLimits& target);
/// Returns the option for commands that hold their input in memory; `what` describes the input in the help.
[[nodiscard]] Option max_memory_option(ReadLimits& target, std::string_view what);

struct LayerOutputOptions {
    std::string format = {};
    std::optional<double> units_mm = {};
    bool short_form = false;
    std::optional<std::uint64_t> max_output = {}; ///< bytes
    ImageArguments image = {};

    /// Returns the format of an output: that of `format`, or of the printer, or of the extension. Throws
    /// Error{usage} if they contradict each other.
    [[nodiscard]] const LayerFormat& chosen(const std::string& output) const;
    /// Returns the extension of outputs in this folder (see LayerFormat::file_extension).
    [[nodiscard]] std::string_view file_extension(const std::string& folder) const;
    /// Throws Error{usage} if options do not apply to the format.
    [[nodiscard]] LayerWriteOptions write_options(const LayerFormat& chosen) const;
};
/// Returns options to be appended to a group.
[[nodiscard]] std::vector<Option> layer_output_options(LayerOutputOptions& target);

/// Returns the names of the formats that take an option, for its help.
[[nodiscard]] std::string formats_with(bool LayerFormat::*takes);
/// Throws Error{usage} that lists these formats if the option is given and the chosen format is not one of
/// them.
void check_format(const LayerFormat& chosen, bool given, std::string_view option, bool LayerFormat::*takes);

struct LayerStepOptions {
    std::string fill = "none";
    std::optional<double> offset;
    std::string offset_corners = "mitre";
    std::optional<std::pair<double, double>> bottom_offset;
    bool largest_only = false;
    std::optional<double> min_area;
    std::optional<double> simplify;

    [[nodiscard]] LayerSteps steps() const;
};
[[nodiscard]] OptionGroup layer_step_options(LayerStepOptions& target);
/// Returns a text such as "3 layers other than sliced: 2 rings united, ..."; `than` describes the layers
/// before the steps.
[[nodiscard]] std::string changes_text(const LayerSteps& steps, const LayerChanges& changes);

[[nodiscard]] const std::vector<std::string>& slice_at_names();

/// Throws Error{usage} that names two options, if both are given and cannot be combined.
void check_conflict(bool first, bool second, std::string_view names, std::string_view reason);

/// Throws Error{usage} if a result would overwrite an input or another result. `more` are results that are
/// not named by options.
void check_outputs(const Command& command, const std::vector<NamedFile>& more = {});

} // namespace lamella::app
