#include "slices/formats/common_layer.hpp"

#include "lamella/core/error.hpp"

#include "container/read_limits.hpp"
#include "core/executor.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/formats/common_layer_geometry.hpp"
#include "slices/formats/common_layer_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Tolerance of heights in millimetres, because the box in a header is rounded.
constexpr double one_height = 1e-6;

/// Returns the kind of each part: contour if it has contours and no hatch line, otherwise hatch.
std::vector<VectorKind> kinds_held(std::span<const RawLayer> layers, std::size_t parts) {
    std::vector<bool> contours(parts);
    std::vector<bool> hatches(parts);
    for (const RawLayer& layer : layers) {
        for (const RawLayer::Run& run : layer.runs)
            (run.kind == RawLayer::Run::Kind::hatch ? hatches : contours)[run.part] = true;
    }
    std::vector<VectorKind> kinds;
    for (std::size_t i = 0; i < parts; ++i)
        kinds.push_back(contours[i] && !hatches[i] ? VectorKind::contour : VectorKind::hatch);
    return kinds;
}

std::string name_of(const BeamSettings& beam) {
    std::string name;
    const auto add = [&](const std::optional<double>& number, std::string_view unit) {
        if (number)
            name += fmt::format("{}{:.6g} {}", name.empty() ? "" : ", ", *number, unit);
    };
    add(beam.power_w, "W");
    add(beam.speed_mm_s, "mm/s");
    add(beam.focus_mm, "mm focus");
    return name;
}

/// Gives a part the exposure that its label specifies, or otherwise that of its settings.
void expose(PartInfo& part, const CommonLayerPart& of, std::optional<Exposure> labelled) {
    part.exposure = std::move(labelled);
    if (!of.beam.any())
        return;
    if (!part.exposure) {
        part.exposure = {.part = part.label.empty() ? fmt::format("part {}", of.number) : part.label,
                         .kind = of.kind,
                         .contour = of.kind == VectorKind::contour ? 1U : 0U,
                         .parameters = unknown_parameters()};
        part.label = part.exposure->label();
    }
    ParameterSet& set = part.exposure->parameters;
    set.name = name_of(of.beam);
    set.power_w = of.beam.power_w.value_or(set.power_w);
    set.speed_mm_s = of.beam.speed_mm_s.value_or(set.speed_mm_s);
    set.focus_mm = of.beam.focus_mm.value_or(set.focus_mm);
}

class CommonLayerFile {
  public:
    using Piece = CommonLayerGeometry;

    CommonLayerFile(std::string_view bytes, const std::string& name, ReadLimits& limits)
        : bytes_(bytes), name_(name), header_(read_common_layer_header(bytes, name, limits)),
          all_(header_, name_, limits, {}) {}

    [[nodiscard]] const CommonLayerHeader& header() const { return header_; }
    [[nodiscard]] CommonLayerGeometry& geometry() { return all_; }

    [[nodiscard]] PieceBegins begins(Executor& executor) {
        if (header_.binary)
            return binary_pieces(bytes_, header_);
        text_.emplace(ascii_pieces(bytes_, name_, header_, executor));
        return text_->begins();
    }
    [[nodiscard]] std::size_t end() const { return bytes_.size(); }
    [[nodiscard]] CommonLayerGeometry parse(std::size_t begin, std::size_t limit,
                                            const Reading& reading) const {
        return header_.binary ? read_binary_piece(bytes_, name_, header_, begin, limit, reading)
                              : read_ascii_piece(bytes_, name_, header_, begin, limit,
                                                 reading.again ? 1 : text_->line(begin), reading);
    }
    void append(CommonLayerGeometry&& piece, ReadLimits& /*limits*/) { all_.append(std::move(piece)); }
    [[nodiscard]] RawLayer layer(CommonLayerGeometry&& piece) const {
        return all_.layer_again(std::move(piece), header_, parts_);
    }

    /// Puts the parts into `file`, and returns their keys.
    const std::vector<CommonLayerPart>& number_parts(LayerFile& file) {
        return parts_ = all_.number_parts(header_, file);
    }

  private:
    std::string_view bytes_;
    std::string name_;
    CommonLayerHeader header_;
    std::optional<TextPieces> text_; ///< of an ASCII file
    CommonLayerGeometry all_;
    std::vector<CommonLayerPart> parts_;
};

} // namespace

bool is_common_layer(std::string_view bytes) {
    constexpr std::size_t longest_preface = 1U << 16; // comments before the header
    const std::size_t at = bytes.substr(0, longest_preface).find(common_layer_start);
    return at != std::string_view::npos;
}

CommonLayerContent read_common_layer_content(std::string_view bytes, const std::string& name,
                                             const ExposureOfPart& exposure_of, ReadLimits& limits,
                                             const Execution& execution) {
    const auto opened = std::make_shared<CommonLayerFile>(bytes, name, limits);
    const CommonLayerHeader& header = opened->header();
    CommonLayerContent content{.file = layer_file(name, header.binary ? "cli" : "cli-ascii", header.units_mm),
                               .layers = {},
                               .parse = {},
                               .bytes = bytes.size()};
    LayerFile& file = content.file;
    read_layers_of(*opened, limits, execution, bytes.size());
    CommonLayerGeometry& geometry = opened->geometry();
    const std::uint64_t found = geometry.layers.size();
    if (found == 0)
        throw Error(ErrorKind::input,
                    fmt::format("{}, byte {}: found no layer; a slice file must have at least one", name,
                                header.end));
    file.warnings = header.warnings;
    if (header.layers && *header.layers != found)
        file.warnings.push_back(
            fmt::format("the header announces {} layers; the file has {}", *header.layers, found));
    file.rounding = geometry.rounding(header.binary);
    append_to(geometry.found(), file.warnings);
    const std::vector<CommonLayerPart>& parts = opened->number_parts(file);
    content.layers = std::move(geometry.layers);
    content.parse = parsing_again<CommonLayerFile>(opened);
    const std::vector<VectorKind> held = kinds_held(content.layers, parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        expose(file.parts[i], parts[i], exposure_of(file.parts[i].label, held[i]));
    sort_by_height(content.layers, file.warnings);
    const RawLayer& first = content.layers.front();
    // The box of the header gives the bottom of the part. Some programs write the heights of the first and
    // the last plane there instead; these are ignored.
    const auto lies_at = [&](std::size_t corner, double z) {
        return std::abs((*header.dimension)[corner] - z) <= one_height * std::max(1.0, std::abs(z));
    };
    const bool has_box = header.dimension && !(lies_at(2, first.z) && lies_at(5, content.layers.back().z));
    content.lowest = has_box ? (*header.dimension)[2] : 0.0;
    content.on_bottom = first.drawn && (has_box ? first.z <= content.lowest : first.z == 0);
    return content;
}

std::vector<double> bottoms_of(std::span<const CommonLayerContent> files, double same, ReadLimits& limits) {
    std::vector<double> heights;
    for (const CommonLayerContent& content : files) {
        limits.make_room(heights, content.layers.size(), [&] { return std::string_view(content.file.path); });
        for (const RawLayer& raw : content.layers)
            heights.push_back(raw.z);
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(
        std::unique(heights.begin(), heights.end(), [&](double a, double b) { return b - a <= same; }),
        heights.end());
    const bool on_bottom = std::any_of(files.begin(), files.end(), [&](const CommonLayerContent& content) {
        return content.on_bottom && content.layers.front().z - heights.front() <= same;
    });
    if (!on_bottom || heights.size() == 1) // a single plane does not determine a thickness
        heights.clear();
    return heights;
}

LayerFile layers_of(CommonLayerContent content, std::span<const double> bottoms, ReadLimits& limits,
                    const Execution& execution) {
    LayerFile& file = content.file;
    std::span<RawLayer> layers(content.layers);
    const std::size_t n = layers.size();
    const double first = layers.front().z;
    double bottom = first;
    if (!bottoms.empty()) {
        if (content.on_bottom) {
            file.guess =
                fmt::format("the first layer, at the bottom of the part (z = {} mm), has contours; heights "
                            "are taken for the bottoms of layers",
                            first);
            file.warnings.push_back(file.guess);
        }
        const double top = bottoms.back() + (bottoms.back() - bottoms[bottoms.size() - 2]);
        for (RawLayer& raw : layers) {
            const auto next = std::upper_bound(bottoms.begin(), bottoms.end(), raw.z);
            raw.z = next == bottoms.end() ? top : *next;
        }
    } else if (n > 1 && !layers.front().drawn) {
        layers = layers.subspan(1);
    } else {
        // A single layer below the bottom of the part does not determine a thickness.
        bottom -= n > 1 ? layers[1].z - first : std::max(0.0, first - content.lowest);
    }
    check_part_planes(file, layers.size(), content.bytes);
    add_layers_by_tops(file, layers, bottom, limits, execution, std::move(content.parse));
    return std::move(file);
}

LayerFile read_common_layer(std::string_view bytes, const std::string& name, ReadLimits& limits,
                            const Execution& execution) {
    ReadLimits of_header(limits);
    if (!read_common_layer_header(bytes, name, of_header).binary)
        limits.keep_text_in_memory(bytes.size());
    CommonLayerContent content = read_common_layer_content(
        bytes, name, [](std::string_view label, VectorKind) { return labelled_exposure(label); }, limits,
        execution);
    const std::vector<double> bottoms = bottoms_of({&content, 1}, 0, limits);
    return layers_of(std::move(content), bottoms, limits, execution);
}

} // namespace lamella
