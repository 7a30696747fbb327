// An archive contains one file after the other, but each layer belongs to all files. So the first file is
// written directly to the archive, and the others wait in a store.

#include "lamella/core/error.hpp"

#include "container/byte_store.hpp"
#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "container/zip_writer.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/left_out.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/formats/ilt_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Returns the code of the vectors in the name of their file. It consists of German initials: st (Stuetze) is
/// a support; s1 is a shell, which is the whole part if there is only one beam; v is the volume; u (unten) is
/// below; s (Schraffur) is a hatch; k (Kontur) is a contour; kv (Versatz) are contours further inwards. The
/// upskin has a single code.
std::string code_of(const Exposure& exposure) {
    const bool contour = exposure.kind == VectorKind::contour;
    switch (exposure.region) {
    case ScanRegion::support:
        return contour ? "st_vk" : "st_vs";
    case ScanRegion::upskin:
        return "s1_skin";
    case ScanRegion::downskin:
        return contour ? "s1_uk" : "s1_us";
    default:
        return !contour ? "s1_vs" : exposure.contour > 1 ? "s1_kv" : "s1_vk";
    }
}

/// Returns the exposure that is written for parts without one. Machines ignore it.
Exposure no_exposure(const std::string& part) {
    return {.part = part, .parameters = unknown_parameters()};
}

/// Returns those parameters of a set that the list of files can hold.
ParameterSet kept_in_list(ParameterSet set) {
    set.jump_speed_mm_s = set.spot_mm = set.mark_delay_us = set.jump_delay_us = 0;
    return set;
}

/// A file of the archive.
struct WrittenSection {
    std::string name;
    std::string code; ///< in the name
    ParameterSet parameters;
    std::vector<std::size_t> parts; ///< indices in LayerFileInfo::parts
};

/// Returns the files of the archive. Vectors of a part share a file if their codes and parameters are equal.
/// The name of a file contains the number of its part, or another number if the name is already taken.
std::vector<WrittenSection> sections_of(const std::vector<PartInfo>& parts) {
    const auto name_of = [](std::size_t number, const std::string& code) {
        return fmt::format("modelsection_{:03}_{}.cli", number, code);
    };
    struct FilesOfPart {
        std::size_t number = 0;
        std::vector<std::size_t> sections = {};
    };
    std::vector<WrittenSection> sections;
    std::map<std::string, FilesOfPart> known;
    std::set<std::string> names;
    std::size_t next = 1;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const Exposure exposure = parts[part].exposure.value_or(no_exposure(parts[part].label));
        const std::string code = code_of(exposure);
        FilesOfPart& files = known[exposure.part];
        if (files.sections.empty())
            files.number = next++;
        const auto same = std::find_if(files.sections.begin(), files.sections.end(), [&](std::size_t i) {
            return sections[i].code == code && sections[i].parameters == exposure.parameters;
        });
        if (same != files.sections.end()) {
            sections[*same].parts.push_back(part);
            continue;
        }
        std::string name = name_of(files.number, code);
        if (!names.insert(name).second) {
            name = name_of(next++, code);
            names.insert(name);
        }
        files.sections.push_back(sections.size());
        sections.push_back({std::move(name), code, exposure.parameters, {part}});
    }
    assert(!sections.empty());
    return sections;
}

/// Returns five lines for each file, since readers expect five. Distance and time of points apply only to
/// pulsed beams, and this beam is not pulsed. The prefix for a millionth is one byte of Latin-1.
std::string parameters_text(const std::vector<WrittenSection>& sections) {
    constexpr std::string_view micro = "\xb5";
    std::string text;
    for (const auto& [name, code, parameters, parts] : sections)
        text += fmt::format("[{}]\nLaserSpeed = {} mm/s\nLaserPower = {} watt\nFocusShift = {} mm\n"
                            "PointDistance = 0.0 {}m\nExposureTime = 0.0 {}s\n\n",
                            name, exact_decimal_text(parameters.speed_mm_s),
                            exact_decimal_text(parameters.power_w), exact_decimal_text(parameters.focus_mm),
                            micro, micro);
    return text;
}

constexpr Holds ilt_holds{.hatches = true,
                          .gaps = false,
                          .parameters = true,
                          .written_label = common_layer_label,
                          .labels_mark_vectors = true,
                          .kept = kept_in_list,
                          .not_kept = "jump speeds, delays and spot sizes"};

class IltWriter final : public OrderedWriter {
  public:
    IltWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : OrderedWriter(info, ilt_holds), zip_(path, Overwriting::yes, info.memory),
          sections_(sections_of(info.parts)), entries_(sections_.size()), units_(options.units_mm),
          short_form_(options.short_form) {
        zip_.add(ilt_parameters, parameters_text(sections_));
        zip_.begin(sections_.front().name, ZipMethod::stored);
        for (std::size_t i = 0; i < sections_.size(); ++i)
            open(i, info, options);
    }

    std::uint64_t bytes() const noexcept override { return zip_.bytes() + waiting_; }

    Findings findings() const override {
        std::vector<Finding> of_entries; // each once, with the names of all entries that have it
        for (std::size_t i = 0; i < sections_.size(); ++i)
            for (const Finding& finding : entries_[i].writer->findings().by_file) {
                const auto same = std::find_if(of_entries.begin(), of_entries.end(), [&](Finding one) {
                    one.entries.clear();
                    return one == finding;
                });
                Finding& known = same != of_entries.end() ? *same : of_entries.emplace_back(finding);
                known.entries.emplace_back(sections_[i].name);
            }
        Findings all = OrderedWriter::findings();
        for (Finding& finding : of_entries)
            all.add(std::move(finding));
        return all;
    }

  private:
    struct FileExtent {
        std::uint64_t offset;
        std::size_t size;
    };
    /// Writer of a file of the archive, and the location of its bytes in the store.
    struct Entry {
        LayerFileChunk chunk;
        std::unique_ptr<LayerWriter> writer;
        std::vector<FileExtent> waiting;
    };

    Write formatted(const Plane& plane) override {
        std::vector<Commit> commits;
        for (std::size_t i = 0; i < sections_.size(); ++i) {
            Plane some;
            for (const std::size_t part : sections_[i].parts)
                some.add(plane.polylines[part], plane.hatches[part]);
            commits.push_back(entries_[i].writer->prepare(some));
        }
        return [this, commits = std::move(commits)](const PlanePosition& offset, Completions& after) {
            check_apart(offset);
            for (const Commit& commit : commits)
                commit.in_order(after);
        };
    }

    void end_file() override {
        for (const Entry& entry : entries_)
            entry.writer->finish();
        zip_.end();
        waiting_ = 0;
        for (std::size_t i = 1; i < sections_.size(); ++i) {
            zip_.begin(sections_[i].name, ZipMethod::stored);
            std::string bytes;
            for (const auto& [offset, size] : entries_[i].waiting) {
                bytes.resize(size);
                store_.read(offset, bytes);
                zip_.append_stored(bytes);
            }
            zip_.end();
        }
        zip_.finish();
    }

    /// Throws if the tops of two planes, as written, differ by at most `ilt_one_plane_mm`. Readers would take
    /// them for one plane.
    void check_apart(const PlanePosition& offset) {
        const double units = offset.top / units_;
        const double top =
            units_ * (short_form_ ? std::nearbyint(units) : static_cast<double>(static_cast<float>(units)));
        if (offset.position > 0 && top - last_top_ <= ilt_one_plane_mm)
            throw Error(
                ErrorKind::usage,
                fmt::format("layer {}: its top, z = {} mm, is not more than {} mm above the one before, and "
                            "planes of ilt that are no further apart are read as one; choose higher layers",
                            offset.index, offset.top, ilt_one_plane_mm));
        last_top_ = top;
    }

    /// Opens a writer for a whole file as a single range, whose bytes go to `put`.
    void open(std::size_t section, const LayerFileInfo& info, const LayerWriteOptions& options) {
        Entry& entry = entries_[section];
        entry.chunk = {0, info.layers,
                       [this, section](std::string_view bytes, const std::shared_ptr<const void>& owner,
                                       Completions& after) {
                           put(section, bytes, owner, after);
                       }};
        LayerFileInfo part_info{.box = info.box,
                                .layers = info.layers,
                                .bottom = info.bottom,
                                .parts = {},
                                .rule = info.rule,
                                .chunk = &entry.chunk,
                                .known_finite = true}; // true, because this writer has checked the layers
        for (const std::size_t part : sections_[section].parts) {
            PartInfo known = info.parts[part];
            known.support = false; // the warning is that of the whole archive
            if (known.exposure) {
                known.label = known.exposure->label();
                known.exposure->parameters = unknown_parameters(); // they are in the list
            }
            known.label =
                label_in_file(known, ilt_holds); // warnings of labels are those of the whole archive
            part_info.parts.push_back(std::move(known));
        }
        entry.writer = open_common_layer_binary({}, part_info, options);
    }

    void put(std::size_t section, std::string_view bytes, const std::shared_ptr<const void>& owner,
             Completions& after) {
        if (section == 0) {
            if (owner)
                zip_.append_stored(bytes, owner, after);
            else
                zip_.append_stored(bytes);
            return;
        }
        if (bytes.empty())
            return;
        std::vector<FileExtent>& waiting = entries_[section].waiting;
        if (!waiting.empty() && waiting.back().offset + waiting.back().size == store_.size() &&
            waiting.back().size + bytes.size() <= ByteStore::block_bytes)
            waiting.back().size += bytes.size();
        else
            waiting.push_back({store_.size(), bytes.size()});
        store_.add(bytes);
        waiting_ += bytes.size();
    }

    ZipWriter zip_;
    std::vector<WrittenSection> sections_;
    std::vector<Entry> entries_; ///< one for each of sections_; addresses must not change
    ByteStore store_;
    std::uint64_t waiting_ = 0; ///< bytes in store_ that are not yet in the archive
    double units_;
    bool short_form_;
    double last_top_ = 0; ///< as read back from the file
};

} // namespace

std::unique_ptr<LayerWriter> open_ilt(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& options) {
    return std::make_unique<IltWriter>(path, info, options);
}

} // namespace lamella
