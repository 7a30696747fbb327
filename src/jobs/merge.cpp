#include "lamella/jobs/merge.hpp"

#include "lamella/contour/rounding.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "container/checked_output.hpp"
#include "container/gzip.hpp"
#include "contour/same_height.hpp"
#include "core/progress.hpp"
#include "slices/engine/common_layer_format.hpp"
#include "system/atomic_file.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

namespace lamella {
namespace {

/// Properties of a file, kept after its layers have been read and released.
struct ShardFile {
    std::string path;
    std::string format;
    double units_mm = 0;
    PlaneRule rule = PlaneRule::section_above;
    std::vector<PartInfo> parts; ///< the label is "" if the file has none
    std::uint64_t layers = 0;
    double bottom = 0;
    double top = 0;
    double thinnest_mm = 0;     ///< of its lowest and its highest layer
    double rounded_heights = 0; ///< sum of the largest moves of top and bottom by the format
    std::vector<std::string> warnings = {};
    Findings findings = {}; ///< in its layers
};

ShardFile look_at(const std::string& path, const LayerReadOptions& reading, const Execution& execution) {
    std::error_code unknown; // the reader reports the reason
    const std::filesystem::file_type type = std::filesystem::status(path, unknown).type();
    if (path == "-" || type == std::filesystem::file_type::fifo ||
        type == std::filesystem::file_type::socket || type == std::filesystem::file_type::character)
        throw Error(ErrorKind::usage, fmt::format("{}: files are read twice to be merged, which standard "
                                                  "input and pipes cannot be; save it to a file first",
                                                  path == "-" ? "standard input" : path));
    const LayerFile file = read_layers(path, reading, execution);
    const LayerStack& layers = file.planes;
    if (layers.empty())
        throw Error(ErrorKind::input, fmt::format("{}: holds no layers", path));
    ShardFile shard{.path = path,
                    .format = file.format,
                    .units_mm = file.units_mm,
                    .rule = file.rule,
                    .parts = file.parts,
                    .layers = layers.size(),
                    .bottom = layers.front().bottom,
                    .top = layers.back().top,
                    .thinnest_mm = std::min(layers.front().thickness(), layers.back().thickness()),
                    .rounded_heights =
                        moved_cut(layers.front(), file.rounding) + moved_cut(layers.back(), file.rounding),
                    .warnings = file.warnings};
    shard.findings = layer_findings(file, LayerUse::kept, InversionSearch::quick, execution);
    return shard;
}

std::vector<std::string> labels_of(const ShardFile& shard) {
    std::vector<std::string> labels;
    for (const PartInfo& part : shard.parts)
        labels.push_back(part.label);
    return labels;
}

/// Returns whether parts may be absent from the file. Some formats list only parts that are not empty; and a
/// shard of scan vectors may have no skin, or end below a part.
bool may_lack_parts(const ShardFile& shard) {
    return layer_format(shard.format, shard.path).filled_parts ||
           std::all_of(shard.parts.begin(), shard.parts.end(),
                       [](const PartInfo& part) { return part.exposure.has_value(); });
}

/// Returns the largest distance allowed between the end of one file and the beginning of the next one. Some
/// programs round heights by up to a hundredth of a layer and do not state it.
double slack_between(const ShardFile& below, const ShardFile& above) {
    return below.rounded_heights + above.rounded_heights +
           std::min(below.thinnest_mm, above.thinnest_mm) / 100 + same_height_mm;
}

void check_neighbours(const ShardFile& below, const ShardFile& above) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{} and {}: {}", below.path, above.path, what));
    };
    if (below.format != above.format)
        refuse(fmt::format("one is {}, the other {}; all must be of one format", below.format, above.format));
    if (below.units_mm != above.units_mm)
        refuse(fmt::format("have units of {:g} and of {:g} mm", below.units_mm, above.units_mm));
    if (below.rule != above.rule)
        refuse(fmt::format("one is cut by {}, the other by {}", plane_rule_name(below.rule),
                           plane_rule_name(above.rule)));
    if (const auto one = labels_of(below), other = labels_of(above);
        one != other && !(may_lack_parts(below) && may_lack_parts(above)))
        refuse(fmt::format("hold different parts ({} and {})", fmt::join(one, ", "), fmt::join(other, ", ")));
    const double slack = slack_between(below, above);
    if (above.bottom > below.top + slack)
        refuse(
            fmt::format("between them is a gap: the layers of one end at z = {:.6g} mm, those of the other "
                        "begin at {:.6g} mm; a file is missing",
                        below.top, above.bottom));
    if (above.bottom < below.top - slack)
        refuse(fmt::format("overlap: the layers of one end at z = {:.6g} mm, those of the other begin at "
                           "{:.6g} mm",
                           below.top, above.bottom));
}

/// Returns the files in ascending order. Throws if neighbours differ in format, units, rule or parts (see
/// `may_lack_parts`), or if their heights do not adjoin.
std::vector<ShardFile> look_at_all(std::span<const std::string> paths, const LayerReadOptions& reading,
                                   const Execution& execution) {
    if (paths.empty())
        throw Error(ErrorKind::usage, "there is nothing to merge");
    std::vector<ShardFile> shards;
    for (const std::string& path : paths)
        shards.push_back(look_at(path, reading, execution));
    std::stable_sort(shards.begin(), shards.end(),
                     [](const ShardFile& a, const ShardFile& b) { return a.bottom < b.bottom; });
    for (std::size_t i = 1; i < shards.size(); ++i)
        check_neighbours(shards[i - 1], shards[i]);
    return shards;
}

/// Throws if the existing file `output` appears to be an input. The first argument names the output. If a
/// user forgets it, the first input is taken for the output; the layers of that file adjoin those of the
/// inputs. The layers of an earlier result do not adjoin them.
void check_output(const std::string& output, std::span<const ShardFile> shards,
                  const LayerReadOptions& reading, const Execution& execution) {
    std::error_code error;
    if (output == "-" || !std::filesystem::is_regular_file(output, error))
        return;
    const auto adjoins = [](const ShardFile& below, const ShardFile& above) {
        return std::abs(above.bottom - below.top) <= slack_between(below, above);
    };
    std::optional<ShardFile> other;
    try {
        other = look_at(output, reading, execution);
    } catch (const Error& unread) {
        if (unread.kind() == ErrorKind::cancelled)
            throw;
        return; // it is not a slice file
    }
    const bool above = adjoins(shards.back(), *other);
    if (above || adjoins(*other, shards.front()))
        throw Error(ErrorKind::usage,
                    fmt::format("{}: is to be written, but holds layers that adjoin those of {}; name the "
                                "output first and all files behind it, or remove it",
                                output, above ? shards.back().path : shards.front().path));
}

// ------------------------------------------------------------------------------- Common Layer Interface

/// A file in the layout of our writer. It consists of a header with the number of layers, a layer without
/// contours at the bottom of the first real layer, and the real layers.
struct CommonLayerFile {
    ByteSource source;
    std::string_view before_count; ///< the header up to the number of layers
    std::string_view after_count;  ///< from there to the end of the first layer
    std::string_view layers;       ///< all other layers
    std::string_view tail;
};

[[noreturn]] void refuse_layout(const std::string& path) {
    throw Error(ErrorKind::input,
                fmt::format("{}: is not laid out as Lamella writes it, with an empty layer below the first "
                            "one; convert the files to another format first",
                            path));
}

/// Returns the offset of the end of the first layer, with which the binary form must begin. Throws unless the
/// last command ends at the end of the file.
std::size_t end_of_first_layer(std::string_view text, std::size_t begin, const std::string& path) {
    const auto size_at = [&](std::size_t at) {
        const std::optional<std::uint64_t> size = common_layer_command_size(text.substr(at));
        if (!size)
            refuse_layout(path);
        return *size;
    };
    const std::string_view rest = text.substr(begin);
    std::uint16_t command = 0;
    std::memcpy(&command, rest.data(), std::min(rest.size(), sizeof command));
    if (command != static_cast<std::uint16_t>(CommonLayerCommand::layer_long) &&
        command != static_cast<std::uint16_t>(CommonLayerCommand::layer_short))
        refuse_layout(path);
    const std::size_t end = begin + size_at(begin);
    for (std::size_t at = end; at < text.size();)
        at += size_at(at);
    return end;
}

CommonLayerFile take_apart(const ShardFile& shard, const LayerReadOptions& reading,
                           const Execution& execution) {
    const std::string& path = shard.path;
    CommonLayerFile file{unpacked(open_bytes(path, execution, memory_of_file(reading.max_memory)),
                                  reading.max_memory, execution),
                         {},
                         {},
                         {},
                         {}};
    const std::string_view text = file.source.text();
    // The number of layers must be the last line of the header. Headers with comments are excluded, since a
    // line of a comment may look like a key; so are headers of other programs, which may have data of their
    // own.
    const std::string count = fmt::format("{}", shard.layers + 1);
    const std::string counted = fmt::format("\n$$LAYERS/{}\n$$HEADEREND", count);
    const std::size_t end = text.find("\n$$LAYERS/");
    if (end == std::string_view::npos || !text.substr(end).starts_with(counted))
        refuse_layout(path);
    const std::string_view header = text.substr(0, end);
    if (!header.starts_with("$$HEADERSTART\n") || header.find("\n//") != std::string_view::npos ||
        header.find("$$USERDATA") != std::string_view::npos ||
        header.find("$$ALIGN") != std::string_view::npos)
        refuse_layout(path);
    std::size_t first = end + counted.size();
    if (header.find("\n$$BINARY\n") != std::string_view::npos) {
        first = end_of_first_layer(text, first, path);
    } else {
        constexpr std::string_view start = "\n$$GEOMETRYSTART\n$$LAYER/";
        constexpr std::string_view tail = "$$GEOMETRYEND\n";
        if (!text.substr(first).starts_with(start) || !text.ends_with(tail) ||
            text.find("//", first) != std::string_view::npos)
            refuse_layout(path);
        first = text.find_first_not_of("+-.0123456789Ee", first + start.size());
        if (text[first++] != '\n')
            refuse_layout(path);
        file.tail = tail;
    }
    const std::size_t behind = end + counted.find(count) + count.size();
    file.before_count = text.substr(0, behind - count.size());
    file.after_count = text.substr(behind, first - behind);
    file.layers = text.substr(first, text.size() - first - file.tail.size());
    return file;
}

/// Throws unless the lines of the headers agree except for the number of layers.
void check_heads(const std::string& one, std::string_view header, const std::string& other,
                 std::string_view other_header) {
    if (header == other_header)
        return;
    const auto differ = std::mismatch(header.begin(), header.end(), other_header.begin(), other_header.end());
    const auto line = [](std::string_view text, std::size_t at) {
        const std::size_t begin = text.rfind('\n', at == 0 ? 0 : at - 1) + 1;
        return text.substr(begin, text.find('\n', begin) - begin);
    };
    throw Error(
        ErrorKind::input,
        fmt::format("{} and {}: their headers differ: found {} and {}; they are not of one job", one, other,
                    line(header, static_cast<std::size_t>(differ.first - header.begin())),
                    line(other_header, static_cast<std::size_t>(differ.second - other_header.begin()))));
}

std::uint64_t join_common_layers(const std::vector<ShardFile>& shards, std::uint64_t layers,
                                 const std::string& output, const LayerWriteOptions& options,
                                 const LayerReadOptions& reading, const Execution& execution) {
    AtomicFile out(output);
    std::string header;
    for (std::size_t i = 0; i < shards.size(); ++i) {
        // Bytes are copied unchanged, including any defects.
        if (!shards[i].warnings.empty())
            throw Error(ErrorKind::input,
                        fmt::format("{}: is not sound: {}", shards[i].path, shards[i].warnings.front()));
        const CommonLayerFile file = take_apart(shards[i], reading, execution);
        if (i == 0) {
            header = file.before_count;
            out.append(header);
            out.append(fmt::format("{}", layers + 1));
            out.append(file.after_count);
        }
        check_heads(shards.front().path, header, shards[i].path, file.before_count);
        constexpr std::size_t at_once = std::size_t{1} << 22;
        for (std::size_t at = 0; at < file.layers.size(); at += at_once) {
            if (execution.cancelled())
                throw Error(ErrorKind::cancelled, "cancelled");
            const std::string_view piece = file.layers.substr(at, at_once);
            out.append(piece);
            check_bytes(output, out.bytes(), options.most_bytes);
            release(file.source, std::as_bytes(std::span(piece)));
        }
        if (i + 1 == shards.size())
            out.append(file.tail);
    }
    out.commit();
    return out.bytes();
}

// ------------------------------------------------------------------------------------------ any format

/// A part as in the first file that lists it.
struct KnownPart {
    PartInfo info;
    const std::string* path;
    std::vector<std::size_t> next = {}; ///< parts that follow it in one of the files
    std::size_t waits_for = 0;          ///< number of parts that must precede it
};

/// Throws if a part has different parameters in two files, so that no parameters are replaced silently.
void check_parameters(const KnownPart& known, const PartInfo& part, const std::string& path) {
    const auto refuse = [&](std::string_view name, const auto& one, const auto& other) {
        throw Error(
            ErrorKind::input,
            fmt::format("{} and {}: the part {} has {} {} in one and {} in the other; they are not of "
                        "one job",
                        *known.path, path, part.label, name, one, other));
    };
    if (!known.info.exposure || !part.exposure) {
        if (known.info.exposure.has_value() != part.exposure.has_value())
            refuse("parameters of scan vectors:", known.info.exposure ? "some" : "none",
                   part.exposure ? "some" : "none");
        return;
    }
    const ParameterSet& one = known.info.exposure->parameters;
    const ParameterSet& other = part.exposure->parameters;
    if (one == other)
        return;
    for (const StrategyField<ParameterSet>& field : parameter_fields()) {
        const auto member = std::get<double ParameterSet::*>(field.member);
        if (one.*member != other.*member)
            refuse(field.name, one.*member, other.*member);
    }
    refuse("parameters called", one.name, other.name);
}

/// Returns the parts of all files, with their united boxes, in an order consistent with each file. If the
/// files do not determine the order of two parts, the part of the lower file comes first.
std::vector<PartInfo> parts_of(const std::vector<ShardFile>& shards) {
    std::vector<KnownPart> all;
    // Indices of parts by label, and by the number of preceding parts with the same label in a file.
    std::map<std::pair<std::string_view, std::size_t>, std::size_t> numbers;
    for (const ShardFile& shard : shards) {
        std::map<std::string_view, std::size_t> met;
        std::optional<std::size_t> before;
        for (const PartInfo& part : shard.parts) {
            const auto [position, added] = numbers.try_emplace({part.label, met[part.label]++}, all.size());
            const std::size_t number = position->second;
            if (added) {
                all.push_back({part, &shard.path});
            } else {
                check_parameters(all[number], part, shard.path);
                all[number].info.box.add(part.box);
            }
            if (before) {
                all[*before].next.push_back(number);
                ++all[number].waits_for;
            }
            before = number;
        }
    }
    std::set<std::size_t> ready;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].waits_for == 0)
            ready.insert(i);
    std::vector<PartInfo> parts;
    while (!ready.empty()) {
        KnownPart& part = all[ready.extract(ready.begin()).value()];
        for (const std::size_t next : part.next)
            if (--all[next].waits_for == 0)
                ready.insert(next);
        parts.push_back(std::move(part.info));
    }
    if (parts.size() < all.size()) {
        // Follows the predecessors of any blocked part until a part repeats. This part is on the cycle.
        const auto waits = [](const KnownPart& part) {
            return part.waits_for > 0;
        };
        std::set<const KnownPart*> seen;
        const KnownPart* part = &*std::find_if(all.begin(), all.end(), waits);
        while (seen.insert(part).second)
            part = &*std::find_if(all.begin(), all.end(), [&](const KnownPart& one) {
                return waits(one) && std::any_of(one.next.begin(), one.next.end(),
                                                 [&](std::size_t next) { return &all[next] == part; });
            });
        throw Error(ErrorKind::input,
                    fmt::format("{}: the part {} comes before others that come before it in another of the "
                                "files; they are not of one job",
                                *part->path, part->info.label));
    }
    return parts;
}

/// Returns the layer of each part on a plane of a file, with its hatch lines. The layer is empty if the file
/// does not list the part.
Plane plane_of(const LayerFile& file, std::size_t plane, Plane of_file, const std::vector<PartInfo>& parts) {
    const Layer& any = file.planes[plane];
    Plane vectors;
    std::size_t next = 0;
    for (const PartInfo& part : parts) {
        if (next != file.parts.size() && file.parts[next].label == part.label) {
            vectors.add(std::move(of_file.polylines[next]), std::move(of_file.hatches[next]));
            ++next;
        } else {
            vectors.add({.index = any.index, .z = any.z, .bottom = any.bottom, .top = any.top}, {});
        }
    }
    assert(next == file.parts.size()); // parts_of keeps the order of each file
    return vectors;
}

void write_anew(const std::vector<ShardFile>& shards, const std::string& output, const LayerFormat& format,
                const LayerWriteOptions& options, const LayerReadOptions& reading, MergeResult& result,
                const Execution& execution) {
    const std::vector<PartInfo> parts = parts_of(shards);
    PlaneSource all; // of which the header needs no more
    all.planes = {{.bottom = result.bottom, .top = result.top}};
    all.parts = parts;
    all.rule = shards.front().rule;
    LayerFileInfo info = info_of(all);
    info.layers = result.layers;
    const std::unique_ptr<LayerWriter> writer = open_layer_writer(output, format, info, options);
    double top = result.bottom;
    std::uint64_t next = 0; // lowest unused index
    for (const ShardFile& shard : shards) {
        const LayerFile file = read_layers(shard.path, reading, execution);
        // At the boundary of two files the rounding errors of two heights and of a thickness add up.
        const double rounded = file.rounding.single_precision ? 2 * file.rounding.step_at(top) : 0;
        // Formats without indices count each file from 0.
        const LayerStack& known = file.planes;
        const std::uint64_t moved = next > known.front().index ? next - known.front().index : 0;
        const PlaneSink write = [&](std::size_t i, Plane of_file) {
            Plane plane = plane_of(file, i, std::move(of_file), parts);
            for (Layer& layer : plane.polylines) {
                layer.index += moved;
                if (i == 0 && std::abs(layer.bottom - top) <= rounded)
                    layer.bottom = top;
            }
            return writer->prepare(plane);
        };
        file.run(Stage::write, write, without_progress(execution)); // a stage must not repeat for each file
        top = known.back().top;
        next = known.back().index + moved + 1;
    }
    writer->finish();
    result.bytes = writer->bytes();
    for (const ShardFile& shard : shards)
        for (const std::string& warning : shard.warnings)
            result.file_warnings.push_back(fmt::format("{}: {}", shard.path, warning));
    result.losses = writer->findings();
}

} // namespace

MergeResult merge_layer_files(std::span<const std::string> paths, const std::string& output,
                              const MergeOptions& options, const Execution& execution) {
    const LayerFormat& to = layer_format(options.format, output);
    const LayerWriteOptions& writing = options.writing;
    LayerReadOptions reading = options.reading;
    reading.kept = KeptPlanes::if_faster;
    const std::vector<ShardFile> shards = look_at_all(paths, reading, execution);
    check_output(output, shards, reading, execution);
    MergeResult result{.format = shards.front().format,
                       .layers = 0,
                       .bottom = shards.front().bottom,
                       .top = shards.back().top,
                       .bytes = 0,
                       .file_warnings = {},
                       .losses = {}};
    for (const ShardFile& shard : shards)
        result.layers += shard.layers;
    const bool as_they_are = !writing.short_form && !has_gzip_extension(output) &&
                             (writing.units_mm == LayerWriteOptions::usual_units_mm ||
                              writing.units_mm == shards.front().units_mm);
    if (to.joins && to.name == result.format && as_they_are)
        result.bytes = join_common_layers(shards, result.layers, output, writing, reading, execution);
    else
        write_anew(shards, output, to, writing, reading, result, execution);
    for (const ShardFile& shard : shards)
        for (const std::string& text : shard.findings.texts())
            result.file_warnings.push_back(fmt::format("{}: {}", shard.path, text));
    return result;
}

} // namespace lamella
