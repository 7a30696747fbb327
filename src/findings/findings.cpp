#include "lamella/findings/findings.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

namespace lamella {
namespace {

/// Returns " of the part "ring"", " of the parts "a", "b" and 5 more"; "" for none, which means all.
std::string of_parts(std::span<const std::string> labels) {
    constexpr std::size_t few = 3;
    if (labels.empty())
        return {};
    const std::size_t named = std::min(few, labels.size());
    std::string text = fmt::format(" of the part{} \"{}\"", labels.size() == 1 ? "" : "s",
                                   fmt::join(labels.first(named), "\", \""));
    if (labels.size() > named)
        text += fmt::format(" and {} more", labels.size() - named);
    return text;
}

double shown_z(double z) {
    constexpr double nearly_0 = 1e-7; // rounding error of 0 in single precision
    return std::abs(z) < nearly_0 ? 0 : z;
}

auto key_of(const Finding& finding) {
    return std::tie(finding.kind, finding.file, finding.entries);
}

/// Adds the numbers of a later finding. Layers are counted by the caller, because files share planes.
void add_numbers(Finding& sum, const Finding& later) {
    if (sum.count == 0) {
        sum.first_z = later.first_z;
        sum.first_layer = later.first_layer;
        sum.place = later.place;
    } else {
        sum.first_z = std::min(sum.first_z, later.first_z);
        sum.first_layer = std::min(sum.first_layer, later.first_layer);
    }
    sum.count += later.count;
    sum.or_more = sum.or_more || later.or_more;
    sum.amount += later.amount;
    sum.largest = std::max(sum.largest, later.largest);
    sum.of_layers = std::max(sum.of_layers, later.of_layers);
}

/// Returns the finding with the key of this one, which is inserted without numbers if there is none.
Finding& find_or_insert(std::vector<Finding>& findings, const Finding& key) {
    const auto at =
        std::lower_bound(findings.begin(), findings.end(), key,
                         [](const Finding& a, const Finding& b) { return key_of(a) < key_of(b); });
    if (at != findings.end() && key_of(*at) == key_of(key))
        return *at;
    return *findings.insert(at, Finding{.kind = key.kind, .file = key.file, .entries = key.entries});
}

const Finding& found_or_none(const std::vector<Finding>& findings, FindingKind kind, std::uint32_t file) {
    static const Finding none;
    const auto at = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
        return finding.kind == kind && finding.file == file;
    });
    return at == findings.end() ? none : *at;
}

/// Adds what was found on a plane. Calls for one finding must have ascending planes; `plane` is the last one.
class Sums {
  public:
    Sums(std::vector<Finding>& findings, std::span<const PlaneHeight> planes)
        : findings_(findings), planes_(planes) {}

    void add(const PlaneFinding& found, std::uint32_t file) {
        Finding& sum = find_or_insert(findings_, {.kind = found.kind, .file = file});
        const PlaneHeight& plane = planes_[found.plane];
        const bool of_volume = std::string_view(description(found.kind).unit) == "mm3";
        sum.count += found.count;
        sum.amount += found.amount * (of_volume ? plane.thickness : 1);
        sum.largest = std::max(sum.largest, found.largest);
        sum.of_layers = planes_.size();
        std::uint64_t& last = last_plane_[{found.kind, file}];
        if (sum.layers == 0)
            sum.first_z = plane.z;
        if (sum.layers == 0 || last != found.plane)
            ++sum.layers;
        last = found.plane;
    }

  private:
    std::vector<Finding>& findings_;
    std::span<const PlaneHeight> planes_;
    std::map<std::pair<FindingKind, std::uint32_t>, std::uint64_t> last_plane_;
};

} // namespace

void PlaneFinding::add(const PlaneFinding& other) noexcept {
    count += other.count;
    amount += other.amount;
    largest = std::max(largest, other.largest);
}

std::string Finding::text() const {
    const FindingDescription& row = description(kind);
    const char* const words = count == 1 && *row.one != '\0' ? row.one : row.many;
    const double z = shown_z(first_z);
    std::string text =
        fmt::format(fmt::runtime(words), fmt::arg("count", count), fmt::arg("amount", amount),
                    fmt::arg("largest", largest), fmt::arg("place", place),
                    fmt::arg("first_layer", first_layer), fmt::arg("z", z),
                    fmt::arg("or_more", or_more ? "or more (rings of such a layer were not checked), " : ""),
                    fmt::arg("where", fmt::format("in {} of {}{}, first at z = {:.6g} mm", layers,
                                                  counted(of_layers, "layer"), of_parts(parts), z)),
                    fmt::arg("on_layers", fmt::format("on {}{}, the lowest at z = {:.6g} mm",
                                                      counted(layers, "layer"), of_parts(parts), z)),
                    fmt::arg("layers", counted(of_layers, "layer")), fmt::arg("affected", layers),
                    fmt::arg("cure", row.cure != nullptr ? row.cure(*this) : std::string()));
    if (!entries.empty())
        text.insert(0, entries.front() + ": ");
    if (entries.size() > 1)
        text += fmt::format(" (and in {} more of its files)", entries.size() - 1);
    return text;
}

const Finding& Findings::of(FindingKind kind) const noexcept {
    return found_or_none(total, kind, Finding::all_files);
}

const Finding& Findings::of(FindingKind kind, std::uint32_t file) const noexcept {
    return found_or_none(by_file, kind, file);
}

const Finding* Findings::first(Severity least) const noexcept {
    const auto found = std::find_if(by_file.begin(), by_file.end(), [&](const Finding& finding) {
        return description(finding.kind).severity >= least;
    });
    return found == by_file.end() ? nullptr : &*found;
}

std::vector<FindingNumber> Findings::numbers(FindingOrigin check) const {
    std::vector<FindingNumber> numbers;
    const auto add = [&](const char* key, auto value) {
        if (*key == '\0')
            return;
        const auto same = std::find_if(numbers.begin(), numbers.end(), [&](const FindingNumber& number) {
            return std::string_view(number.key) == key;
        });
        if (same == numbers.end())
            numbers.push_back({key, value});
        else
            std::get<decltype(value)>(same->value) += value;
    };
    const bool of_layers = check == FindingOrigin::layers || check == FindingOrigin::vectors;
    for (const FindingDescription& row : finding_kinds())
        if (row.origin == check || (of_layers && row.origin == FindingOrigin::layers_or_vectors)) {
            add(row.count_key, of(row.kind).count);
            add(row.amount_key, of(row.kind).amount);
            add(row.largest_key, of(row.kind).largest);
        }
    return numbers;
}

std::vector<std::string> Findings::texts() const {
    std::vector<std::string> texts;
    for (const Finding& finding : by_file)
        texts.push_back(finding.text());
    return texts;
}

bool Findings::count_again(FindingKind kind, std::uint64_t count) noexcept {
    for (Finding& finding : by_file)
        if (finding.kind == kind && finding.file == 0 && finding.entries.empty()) {
            finding.count += count;
            const auto sum = std::find_if(total.begin(), total.end(),
                                          [&](const Finding& of_all) { return of_all.kind == kind; });
            sum->count += count;
            return true;
        }
    return false;
}

void Findings::add(Finding finding) {
    Finding& of_file = find_or_insert(by_file, finding);
    add_numbers(of_file, finding);
    of_file.layers += finding.layers;
    Finding& all = find_or_insert(total, {.kind = finding.kind, .file = Finding::all_files});
    add_numbers(all, finding);
    all.layers = std::max(all.layers, of_file.layers);
    std::move(finding.parts.begin(), finding.parts.end(), std::back_inserter(of_file.parts));
}

void Findings::add(const Findings& others) {
    for (const Finding& finding : others.by_file)
        add(finding);
}

void FindingLog::add(std::span<const PlaneFinding> found) {
    const std::lock_guard lock(mutex_);
    std::copy_if(found.begin(), found.end(), std::back_inserter(found_),
                 [](const PlaneFinding& one) { return one.count > 0; });
}

std::vector<PlaneFinding> FindingLog::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(found_, {});
}

/// Returns what was added by ascending plane, kind, file and part, so that sums have the same bits for every
/// order of threads.
std::vector<PlaneFinding> FindingLog::sorted() const {
    std::vector<PlaneFinding> sorted;
    {
        const std::lock_guard lock(mutex_);
        sorted = found_;
    }
    const auto key = [](const PlaneFinding& found) {
        return std::tuple(found.plane, found.kind, found.file, found.part);
    };
    std::sort(sorted.begin(), sorted.end(),
              [&](const PlaneFinding& a, const PlaneFinding& b) { return key(a) < key(b); });
    return sorted;
}

Findings FindingLog::sums(std::span<const PlaneHeight> planes, std::span<const std::string> labels,
                          std::span<const std::uint32_t> files) const {
    Findings sums;
    Sums by_file(sums.by_file, planes);
    Sums total(sums.total, planes);
    std::map<std::pair<FindingKind, std::uint32_t>, std::set<std::uint32_t>> parts;
    for (const PlaneFinding& found : sorted()) {
        by_file.add(found, found.file);
        total.add(found, Finding::all_files);
        if (found.part < labels.size())
            parts[{found.kind, found.file}].insert(found.part);
    }
    // Labels are omitted if all parts of the file are affected.
    for (Finding& finding : sums.by_file) {
        const std::set<std::uint32_t>& affected = parts[{finding.kind, finding.file}];
        if (affected.size() < static_cast<std::size_t>(std::count(files.begin(), files.end(), finding.file)))
            for (const std::uint32_t part : affected)
                finding.parts.push_back(labels[part]);
    }
    return sums;
}

std::vector<PlaneFinding> FindingLog::by_plane() const {
    std::vector<PlaneFinding> planes;
    for (const PlaneFinding& found : sorted()) // by plane, then kind
        if (!planes.empty() && planes.back().plane == found.plane && planes.back().kind == found.kind)
            planes.back().add(found);
        else
            planes.push_back(found);
    return planes;
}

} // namespace lamella
