// The list of parameters names the files of the archive. Each is read as a Common Layer Interface file. Then
// all parts get layers on the union of the planes of all files.

#include "lamella/core/error.hpp"

#include "container/coordinate_text.hpp"
#include "container/decimal_text.hpp"
#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/lower_case.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/formats/common_layer.hpp"
#include "slices/formats/ilt_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Entry of the list for one file.
struct Section {
    std::string name;
    std::size_t line;
    ParameterSet parameters = unknown_parameters();
    bool pulsed = false; ///< true if the beam is pulsed, which causes a warning
    bool has_speed = false;
    bool has_power = false;
};

struct IltUnit {
    std::string_view name; ///< in lower case
    double factor;
};
constexpr IltUnit speeds[] = {{"mm/s", 1}, {"m/s", 1000}};
constexpr IltUnit powers[] = {{"w", 1}, {"watt", 1}, {"watts", 1}, {"kw", 1000}};
constexpr IltUnit lengths[] = {
    {"mm", 1}, {"um", 1e-3}, {"\xb5m", 1e-3}, {"\xc2\xb5m", 1e-3}, {"\xce\xbcm", 1e-3}};

/// A parameter that the list may give for a file.
struct Parameter {
    std::string_view key;
    double ParameterSet::*to; ///< null if the parameter only causes a warning
    std::span<const IltUnit> units;
    bool may_be_negative;
    const char* form;
};
constexpr Parameter known_parameters[] = {
    {"LaserSpeed", &ParameterSet::speed_mm_s, speeds, false, "0 or more, in mm/s or m/s"},
    {"LaserPower", &ParameterSet::power_w, powers, false, "0 or more, in W (watt) or kW"},
    {"FocusShift", &ParameterSet::focus_mm, lengths, true, "in mm or um"},
    {"PointDistance", nullptr, {}, true, "with any unit"},
    {"ExposureTime", nullptr, {}, true, "with any unit"}};

/// Reads a number, alone or followed by a blank and one of these units, such as "200.0 watt".
std::optional<double> number_with_unit(std::string_view text, const Parameter& parameter) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const char* const stop = read_decimal(text.data(), end, number);
    if (stop == nullptr || (stop != end && !is_blank(*stop)) || (number < 0 && !parameter.may_be_negative))
        return std::nullopt;
    const std::string name = lower_case(trimmed({stop, static_cast<std::size_t>(end - stop)}));
    if (name.empty() || parameter.units.empty())
        return number;
    for (const IltUnit& unit : parameter.units)
        if (unit.name == name)
            return number * unit.factor;
    return std::nullopt;
}

/// Reads lines such as "[file.cli]" and, for this file, "LaserPower = 200.0 watt". Skips other lines.
std::vector<Section> read_parameters(std::string_view text, const std::string& name, ReadLimits& limits) {
    std::vector<Section> sections;
    std::size_t line = 1;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view words = trimmed(text.substr(begin, end - begin));
        begin = end + 1;
        if (words.starts_with('[') && words.ends_with(']')) {
            limits.make_room(sections, 1, at_line(line));
            sections.push_back({std::string(words.substr(1, words.size() - 2)), line});
            sections.back().parameters.name = sections.back().name.substr(0, sections.back().name.rfind('.'));
            continue;
        }
        const std::size_t equals = words.find('=');
        if (equals == std::string_view::npos || sections.empty())
            continue;
        const std::string_view key = trimmed(words.substr(0, equals));
        Section& section = sections.back();
        const auto* const parameter = std::find_if(std::begin(known_parameters), std::end(known_parameters),
                                                   [&](const Parameter& known) { return known.key == key; });
        if (parameter == std::end(known_parameters))
            continue;
        const std::string_view value = trimmed(words.substr(equals + 1));
        if (parameter->to == nullptr && (value.empty() || value == "-"))
            continue;
        const std::optional<double> number = number_with_unit(value, *parameter);
        if (!number)
            throw Error(
                ErrorKind::input,
                fmt::format("{}, line {}: found '{}'; {} must be a number, {}, with the unit behind a "
                            "blank",
                            name, line, printable(value, 40), key, parameter->form));
        if (parameter->to == nullptr)
            section.pulsed = section.pulsed || *number != 0;
        else
            section.parameters.*parameter->to = *number;
        section.has_speed = section.has_speed || key == "LaserSpeed";
        section.has_power = section.has_power || key == "LaserPower";
    }
    return sections;
}

/// Warns of files that are not in the list: they have no parameters and are not read.
void report_unlisted(const ZipReader& zip, const std::set<const ZipEntry*>& listed, Findings& found) {
    for (const ZipEntry& entry : zip.entries())
        if (listed.count(&entry) == 0 && lower_case(entry.name).ends_with(".cli"))
            found.note(FindingKind::unlisted_files, [&] { return excerpt(entry.name); });
}

/// A word in the name of a file, and the vectors that it denotes.
struct NameWord {
    std::string_view word; ///< in lower case
    std::optional<ScanRegion> region = {};
    std::optional<VectorKind> kind = {};
    std::uint32_t contour = 1; ///< number of the contour; 1 is the outermost
};

/// Initials of German words: v (Volumen) core, u (unten) downskin, s (Schraffur) hatch, k (Kontur) contour;
/// see docs/formats.md.
constexpr NameWord codes[] = {
    {"vs", ScanRegion::core, VectorKind::hatch},       {"vk", ScanRegion::core, VectorKind::contour},
    {"kv", ScanRegion::core, VectorKind::contour, 2},  {"us", ScanRegion::downskin, VectorKind::hatch},
    {"uk", ScanRegion::downskin, VectorKind::contour}, {"kvu", ScanRegion::downskin, VectorKind::contour, 2},
    {"sx", ScanRegion::support, VectorKind::hatch},    {"skin", ScanRegion::upskin, VectorKind::hatch}};

/// Names of regions in 3DXpert, as in a single example; no description is known. They are alone for hatches,
/// and follow the number of a contour as in "c1md".
constexpr NameWord short_regions[] = {{"md", ScanRegion::core},
                                      {"up", ScanRegion::upskin},
                                      {"dn", ScanRegion::downskin},
                                      {"sp", ScanRegion::support}};

/// Common words. netfabb is said to name files like its stacks of slices, whose names its users choose. That
/// rests on neither a description nor a file of netfabb: the words are taken at their meaning.
constexpr NameWord plain_words[] = {
    {"hatch", {}, VectorKind::hatch},      {"hatches", {}, VectorKind::hatch},
    {"hatching", {}, VectorKind::hatch},   {"hatchings", {}, VectorKind::hatch},
    {"fill", {}, VectorKind::hatch},       {"infill", {}, VectorKind::hatch},
    {"filling", {}, VectorKind::hatch},    {"contour", {}, VectorKind::contour},
    {"contours", {}, VectorKind::contour}, {"outline", {}, VectorKind::contour},
    {"border", {}, VectorKind::contour},   {"core", ScanRegion::core},
    {"volume", ScanRegion::core},          {"inskin", ScanRegion::core},
    {"upskin", ScanRegion::upskin},        {"skin", ScanRegion::upskin},
    {"downskin", ScanRegion::downskin},    {"support", ScanRegion::support},
    {"supports", ScanRegion::support}};

const NameWord* find_word(std::span<const NameWord> words, std::string_view word) {
    const auto found =
        std::find_if(words.begin(), words.end(), [&](const NameWord& known) { return known.word == word; });
    return found == words.end() ? nullptr : &*found;
}

bool is_number(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Takes the words of a name from its end.
class NameWords {
  public:
    explicit NameWords(std::string name) : rest_(std::move(name)) {}

    [[nodiscard]] std::string_view last() const {
        const std::string_view rest = rest_;
        return rest.substr(rest.find_last_of(separators) + 1); // the whole name if there is no separator
    }
    void drop_last() {
        const std::size_t at = rest_.find_last_of(separators);
        rest_.resize(at == std::string::npos ? 0 : at);
    }
    [[nodiscard]] std::size_t left() const { return rest_.size(); }

  private:
    static constexpr std::string_view separators = "_- .";
    std::string rest_;
};

/// Returns the exposure that the name of a file denotes, such as "modelsection_001_s1_vs.cli". If the name
/// gives no kind of vectors, it is `held`. Sets `known` to whether the name contains a known word.
Exposure named_exposure(std::string_view file, VectorKind held, bool& known) {
    const std::string_view name = file.substr(0, file.rfind('.'));
    NameWords words(lower_case(std::string(name)));
    Exposure exposure;
    exposure.kind = held;
    std::optional<std::uint32_t> contour;
    known = true;
    const auto take = [&](const NameWord& word) {
        exposure.region = word.region.value_or(exposure.region);
        exposure.kind = word.kind.value_or(exposure.kind);
        words.drop_last();
    };
    if (const NameWord* const code = find_word(codes, words.last());
        code != nullptr && words.left() > code->word.size()) {
        NameWords before = words;
        before.drop_last();
        const std::string area(before.last());
        const bool of_shell =
            area.size() >= 2 && area[0] == 's' && is_number(std::string_view(area).substr(1));
        const bool has_area = area == "st" || area == "k" || of_shell;
        if (has_area || code->word != "skin") {
            take(*code);
            contour = code->contour;
        }
        if (has_area)
            words.drop_last();
        if (area == "st")
            exposure.region = ScanRegion::support;
        if (has_area && code->word == "skin")
            exposure.kind = held; // "skin" is used for both kinds
    }
    if (!contour) {
        const std::string last(words.last());
        const std::size_t digits = std::min(last.find_first_not_of("0123456789", 1), last.size());
        const bool numbered = last.starts_with('c') && digits > 1 && digits <= 4;
        if (const NameWord* const region =
                find_word(short_regions, numbered ? std::string_view(last).substr(digits) : last)) {
            take(*region);
            exposure.kind = numbered ? VectorKind::contour : held;
            contour = numbered ? static_cast<std::uint32_t>(std::stoul(last.substr(1, digits - 1))) : 1;
        }
    }
    if (!contour) {
        while (const NameWord* const word = find_word(plain_words, words.last())) {
            take(*word);
            contour = word->contour;
        }
        known = contour.has_value();
    }
    exposure.part = name.substr(0, words.left());
    if (exposure.part.empty())
        exposure.part = name;
    exposure.contour = exposure.kind == VectorKind::contour ? std::max(1U, contour.value_or(1)) : 0;
    return exposure;
}

/// Returns the exposure of a part of a file in the archive. Returns nullopt if the file has no speed and its
/// label does not specify scan vectors. Counts names without a known word in `found`.
std::optional<Exposure> exposure_of(const Section& section, std::string_view label, VectorKind held,
                                    Findings& found) {
    std::optional<Exposure> exposure = labelled_exposure(label);
    if (!exposure && section.parameters.speed_mm_s > 0) {
        bool known = false;
        exposure = named_exposure(section.name, held, known);
        if (!known)
            found.note(FindingKind::unknown_names, [&] { return excerpt(section.name); });
    }
    if (exposure)
        exposure->parameters = section.parameters;
    return exposure;
}

bool same_height(double a, double b) {
    return std::abs(a - b) <= ilt_one_plane_mm;
}

/// Returns the planes of all files as empty layers.
LayerStack planes_of(const std::vector<LayerFile>& files, ReadLimits& limits) {
    LayerStack all;
    for (const LayerFile& file : files) {
        const auto location = [&] {
            return std::string_view(file.path);
        };
        for (const Layer& layer : file.planes) {
            limits.make_room(all, 1, location);
            all.push_back({.z = layer.z, .bottom = layer.bottom, .top = layer.top});
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Layer& a, const Layer& b) { return a.top < b.top; });
    all.erase(std::unique(all.begin(), all.end(),
                          [](const Layer& a, const Layer& b) { return same_height(a.top, b.top); }),
              all.end());
    for (std::size_t i = 0; i < all.size(); ++i) {
        Layer& plane = all[i];
        plane.index = i;
        // If a file omits layers, the layers next to them appear thicker than they are.
        if (i > 0 && plane.bottom < all[i - 1].top) {
            plane.bottom = all[i - 1].top;
            plane.z = plane.bottom + (plane.top - plane.bottom) / 2;
        }
    }
    return all;
}

constexpr std::size_t no_position = std::numeric_limits<std::size_t>::max();

/// Returns the position of the layer of a file on each plane; no_position on planes that it does not have.
std::vector<std::size_t> positions_of(const LayerFile& file, const LayerStack& planes) {
    const LayerStack& layers = file.planes;
    std::vector<std::size_t> positions(planes.size(), no_position);
    std::size_t next = 0;
    for (std::size_t i = 0; i < planes.size(); ++i)
        if (next < layers.size() && same_height(layers[next].top, planes[i].top))
            positions[i] = next++;
    if (next != layers.size())
        throw Error(ErrorKind::input,
                    fmt::format("{}: found layers at z = {} mm that are thinner than {} mm; they cannot be "
                                "apart",
                                file.path, layers[next].top, ilt_one_plane_mm));
    return positions;
}

/// A file of the archive, and the positions of its layers on the planes of all files.
struct JoinedFile {
    ByteSource source; ///< empty if layers are kept in memory
    LayerFile file;
    std::vector<std::size_t> positions;
};

/// Makes a plane of the layers of all files.
Plane joined_plane(const std::vector<JoinedFile>& files, std::size_t plane) {
    Plane vectors;
    for (const auto& [source, file, positions] : files) {
        if (positions[plane] != no_position)
            vectors.append(file.make(positions[plane]));
        else
            for (std::size_t part = 0; part < file.parts.size(); ++part)
                vectors.add({}, {});
    }
    return vectors;
}

/// Gives the result the parts of all files, on the planes of all of them. Layers that are parsed again refer
/// to the sources, of which the archive has this many bytes.
void join(LayerFile& result, std::vector<LayerFile> files, std::vector<ByteSource> sources,
          std::uint64_t bytes, ReadLimits& limits) {
    result.planes = planes_of(files, limits);
    result.contents.resize(result.planes.size());
    std::vector<JoinedFile> joined;
    for (std::size_t i = 0; i < files.size(); ++i) {
        LayerFile& file = files[i];
        limits.add_bytes(result.planes.size() * (sizeof(PlaneContent) + sizeof(std::size_t)), file.path);
        const std::vector<std::size_t> positions = positions_of(file, result.planes);
        for (PartInfo part : file.parts) {
            if (part.exposure && !labelled_exposure(part.label)) {
                if (file.parts.size() > 1 && !part.label.empty())
                    part.exposure->part += ' ' + part.label;
                part.label = part.exposure->label();
            }
            if (!part.box.empty()) {
                part.box.min.z = result.planes.front().bottom;
                part.box.max.z = result.planes.back().top;
            }
            result.parts.push_back(std::move(part));
            check_part_planes(result, result.planes.size(), bytes);
        }
        for (std::size_t plane = 0; plane < positions.size(); ++plane)
            if (positions[plane] != no_position) {
                const PlaneContent& content = file.contents[positions[plane]];
                result.contents[plane].points += content.points;
                result.contents[plane].hatch_lines += content.hatch_lines;
            }
        result.largest_coordinate = std::max(result.largest_coordinate, file.largest_coordinate);
        result.largest_hatch_coordinate =
            std::max(result.largest_hatch_coordinate, file.largest_hatch_coordinate);
        result.bytes += file.bytes;
        result.plane_bytes += file.plane_bytes;
        joined.push_back({std::move(sources[i]), std::move(file), positions});
    }
    if (!limits.in_memory()) {
        result.bytes = limits.bytes();
        result.spare_bytes = limits.bytes_left();
    }
    result.make =
        [joined = std::make_shared<const std::vector<JoinedFile>>(std::move(joined))](std::size_t plane) {
            return joined_plane(*joined, plane);
        };
}

} // namespace

bool is_ilt(const ZipReader& zip) {
    return zip.find(ilt_parameters) != nullptr;
}

LayerFile read_ilt(const ZipReader& zip, ReadLimits& limits, const Execution& execution) {
    const ByteSource list = unpacked_entry(zip, *zip.find(ilt_parameters), limits);
    std::vector<CommonLayerContent> contents;
    LayerFile result = layer_file(zip.name(), "ilt");
    result.warnings = zip.counted_warnings();
    std::uint64_t bytes = 0;
    std::vector<std::string> sections; // of `contents`
    std::vector<ByteSource> sources;   // likewise; layers that are parsed again refer to their bytes
    std::set<const ZipEntry*> known;
    Findings found;
    const std::string_view text = list.text().substr(after_byte_order_mark(list.text()));
    for (const Section& section : read_parameters(text, list.name, limits)) {
        const ZipEntry* const entry = zip.find(section.name);
        if (entry == nullptr || !known.insert(entry).second)
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found parameters of '{}'{}", list.name, section.line,
                                    excerpt(section.name),
                                    entry == nullptr
                                        ? "; the archive has no such file"
                                        : " a second time; there must be one list for each file"));
        if (section.pulsed)
            found.note(FindingKind::pulsed_beams, at_line(section.line));
        if (section.has_speed != section.has_power)
            found.note(FindingKind::halves_of_settings, at_line(section.line));
        sources.push_back(unpacked_entry(zip, *entry, limits));
        const ByteSource& source = sources.back();
        bytes += source.bytes.size();
        if (!is_common_layer(source.text()))
            throw Error(
                ErrorKind::input,
                fmt::format("{}: found no Common Layer Interface header ($$HEADERSTART); files of this "
                            "archive must have one",
                            source.name));
        contents.push_back(read_common_layer_content(
            source.text(), source.name,
            [&](std::string_view label, VectorKind held) { return exposure_of(section, label, held, found); },
            limits, execution));
        if (limits.in_memory())
            sources.back() = {};
        sections.push_back(section.name);
    }
    if (contents.empty())
        throw Error(ErrorKind::input,
                    fmt::format("{}: found parameters of no file; there must be one at least", list.name));
    // The heights of all files together decide whether they are tops or bottoms of layers.
    const std::vector<double> bottoms = bottoms_of(contents, ilt_one_plane_mm, limits);
    std::vector<LayerFile> files;
    for (std::size_t i = 0; i < contents.size(); ++i) {
        files.push_back(layers_of(std::move(contents[i]), bottoms, limits, execution));
        for (const std::string& warning : files.back().warnings)
            result.warnings.push_back(fmt::format("{}: {}", sections[i], warning));
    }
    report_unlisted(zip, known, found);
    append_to(found, result.warnings);
    result.units_mm = files.front().units_mm;
    result.rounding = files.front().rounding;
    for (const LayerFile& file : files)
        result.rounding.step_mm = std::min(result.rounding.step_mm, file.rounding.step_mm);
    join(result, std::move(files), std::move(sources), bytes, limits);
    return result;
}

} // namespace lamella
