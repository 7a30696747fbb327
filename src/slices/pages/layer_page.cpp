#include "lamella/slices/layer_page.hpp"

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/selection.hpp"
#include "lamella/polygon/simplify.hpp"

#include "container/base64.hpp"
#include "container/deflate.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/pages/page_bytes.hpp"
#include "slices/pages/page_text.hpp"
#include "system/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Figures of a complete plane, even if the page shows only a part of it.
struct PlaneFacts {
    PlanePosition position;
    LayerMeasure measure = {};
    OpenGaps gaps = {};
    std::uint64_t crossings = 0;
    std::uint64_t misoriented = 0;
    std::uint64_t overlapping = 0;
    std::uint64_t hatches = 0;
    ScanFigures scan = {};
};

/// The data of a plane for the page, complete or thinned out.
struct Image {
    std::string bytes; ///< compressed
    std::uint64_t shown = 0;
    std::uint64_t contours_shown = 0;
    std::uint64_t hatches_shown = 0;
    double tolerance_mm = 0;
};

/// Largest number of crossings of a plane whose locations are listed.
constexpr std::size_t most_marks = 1000;

/// Fills in the figures and defects of a plane, and appends the locations of the first crossings.
void look_at(const Plane& plane, std::span<const PartInfo> parts, PlaneFacts& facts,
             std::vector<Point2>& positions) {
    const auto look_for_crossings = [&](const Layer& layer) {
        const Crossings crossings = find_crossings(layer, most_marks - positions.size());
        facts.crossings += crossings.count;
        for (const Crossing& crossing : crossings.first)
            positions.push_back(crossing.at);
    };
    std::optional<Point2> beam;
    std::vector<Layer> bounding; // layers that bound material, which are checked together
    for (std::size_t i = 0; i < plane.polylines.size(); ++i) {
        const Layer& layer = plane.polylines[i];
        const std::span<const Point2> hatches = plane.hatches[i].span();
        facts.hatches += hatches.size() / 2;
        if (parts[i].exposure) {
            look_for_crossings(layer);
            // Vectors do not bound material, so their area, nesting and open chains are not examined.
            const MeasuredVectors measured =
                measure_vectors(layer, hatches, parts[i].exposure->parameters, beam);
            beam = measured.beam;
            facts.scan += measured.figures;
            facts.measure.contours += layer.contours();
            facts.measure.points += layer.points.size();
            continue;
        }
        facts.measure.add(measure(layer));
        facts.gaps += open_gaps(layer);
        bounding.push_back(layer);
    }
    if (bounding.empty())
        return;
    const Layer all = bounding.size() == 1 ? std::move(bounding.front()) : merged(bounding);
    look_for_crossings(all);
    const Nesting nested = nesting(all);
    facts.misoriented +=
        static_cast<std::uint64_t>(std::count(nested.kind.begin(), nested.kind.end(), RingKind::misoriented));
    facts.measure.holes -=
        std::min<std::uint64_t>(facts.measure.holes, facts.misoriented); // these are clockwise, too
    facts.overlapping +=
        static_cast<std::uint64_t>(std::count(nested.kind.begin(), nested.kind.end(), RingKind::overlapping));
}

/// The layers of a plane, which lose detail step by step. No contour moves by more than `tolerance_mm` in
/// total. Remaining contours keep their order, since the page shows the order of scan vectors.
class Thinning {
  public:
    Thinning(Plane plane, double step_mm) : plane_(std::move(plane)), step_mm_(step_mm) {}

    /// The first call drops hatches, if there are any. Later calls simplify to a tolerance of one step, then
    /// to four times the previous tolerance, which halves the number of points of curves. Specks are dropped
    /// once the tolerance is visible.
    void coarsen() {
        if (drop_hatches())
            return;
        const double tolerance = tolerance_mm_ == 0 ? step_mm_ : 4 * tolerance_mm_;
        for (Layer& layer : plane_.polylines) {
            layer = simplify_each(layer, tolerance - tolerance_mm_);
            if (tolerance > steps_of_specks * step_mm_)
                layer = without_small_rings(layer, tolerance * tolerance);
        }
        tolerance_mm_ = tolerance;
    }
    [[nodiscard]] bool at_end() const noexcept { return tolerance_mm_ >= most_steps * step_mm_; }
    [[nodiscard]] const Plane& plane() const noexcept { return plane_; }
    [[nodiscard]] double tolerance_mm() const noexcept { return tolerance_mm_; }

  private:
    /// Drops the hatches; returns whether there were any.
    bool drop_hatches() {
        bool any = false;
        for (PointArray& lines : plane_.hatches)
            any |= !std::exchange(lines, {}).empty();
        return any;
    }

    static constexpr double steps_of_specks = 7.5;
    static constexpr double most_steps = 512; // a hundredth of the part

    Plane plane_;
    double step_mm_;
    double tolerance_mm_ = 0;
};

struct Cost {
    std::uint64_t bytes = 0;
    std::uint64_t points = 0;

    [[nodiscard]] bool within(const Cost& most) const noexcept {
        return bytes <= most.bytes && points <= most.points;
    }
};

Cost cost_of(const Image& image) {
    return {base64_size(image.bytes.size()), image.shown};
}

constexpr std::uint64_t most_shares = 4; // largest multiple of a thinned layer's budget

/// Distributes the bytes of a page: an equal share for each layer, plus bytes that the layers below did not
/// use, up to four shares in total.
///
/// A layer of scan vectors may use all unused bytes if it is kept complete. Otherwise it gets a quarter of
/// its share, and layers above may use the rest. All vectors of every tenth layer are more useful than all
/// layers without their hatches.
class Budget {
  public:
    Budget(const PageOptions& options, std::uint64_t layers, bool vectors)
        : bytes_(options.budget_bytes / std::max<std::uint64_t>(1, layers)), thinned_{vectors ? bytes_ / 4
                                                                                              : bytes_,
                                                                                      options.layer_points},
          vectors_(vectors) {}

    /// Returns the budget of a layer that is thinned out.
    [[nodiscard]] const Cost& thinned() const noexcept { return thinned_; }

    /// Returns the first of these versions of the next layer that is within the budget, or the last one. The
    /// versions must begin with the finest.
    const Image& choose(const std::vector<Image>& images) {
        const std::uint64_t left = saved_bytes_ + bytes_;
        const Cost most{vectors_ ? left : std::min(left, most_shares * bytes_), thinned_.points};
        const auto fitting = std::find_if(images.begin(), images.end(), [&](const Image& image) {
            const bool whole = &image == &images.front();
            return cost_of(image).within(vectors_ && !whole ? thinned_ : most);
        });
        const Image& chosen = fitting == images.end() ? images.back() : *fitting;
        saved_bytes_ = left - std::min(left, cost_of(chosen).bytes);
        return chosen;
    }

  private:
    std::uint64_t bytes_; ///< equal share of each layer
    Cost thinned_;
    bool vectors_;
    std::uint64_t saved_bytes_ = 0;
};

/// Returns versions of a plane: the complete plane, then versions with less and less detail. The last version
/// costs at most `thinned`, or at most four times as many bytes if further thinning saves little; or it
/// cannot be thinned any further.
std::vector<Image> images_of(const Plane& whole, std::span<const PartInfo> infos,
                             std::span<const Point2> positions, const PageGrid& grid, const Cost& thinned) {
    const auto image = [&](const Plane& plane, double tolerance) {
        Image made{.bytes = {}, .tolerance_mm = tolerance};
        made.bytes = deflated(layer_numbers(plane, infos, positions, grid, made.shown).view());
        for (const Layer& layer : plane.polylines)
            made.contours_shown += layer.contours();
        for (const PointArray& hatches : plane.hatches)
            made.hatches_shown += hatches.size() / 2;
        return made;
    };
    std::vector<Image> images{image(whole, 0)};
    Thinning thinning(whole, grid.step_mm);
    const Cost most{most_shares * thinned.bytes, thinned.points};
    bool saves = true;
    const auto shows_nothing = [](const Image& made) {
        return made.contours_shown == 0 && made.hatches_shown == 0;
    };
    for (Cost cost = cost_of(images.back());
         !cost.within(thinned) && !thinning.at_end() && !shows_nothing(images.back());) {
        if (!saves && cost.within(most))
            break; // many small rings remain; a larger page is better than a crude one
        thinning.coarsen();
        images.push_back(image(thinning.plane(), thinning.tolerance_mm()));
        const Cost next = cost_of(images.back());
        saves = next.bytes < cost.bytes / 10 * 9 || next.points < cost.points / 10 * 9;
        cost = next;
    }
    return images;
}

/// Columns of numbers about the planes, as JSON that grows row by row.
class PlaneTable {
  public:
    /// `vectors` adds the columns about scan vectors.
    explicit PlaneTable(bool vectors) : shown_(vectors ? columns.size() : columns.size() - columns_of_scan) {}

    void add(const PlaneFacts& facts, const Image& image) {
        const std::array<std::string, columns.size()> values{std::to_string(facts.position.index),
                                                             page_number(facts.position.z),
                                                             page_number(facts.position.bottom),
                                                             page_number(facts.position.top),
                                                             page_number(facts.measure.area_mm2),
                                                             page_number(facts.measure.perimeter_mm),
                                                             std::to_string(facts.measure.contours),
                                                             std::to_string(facts.measure.holes),
                                                             std::to_string(facts.measure.points),
                                                             std::to_string(facts.measure.open_chains),
                                                             page_number(facts.gaps.longest_mm),
                                                             page_number(facts.gaps.total_mm),
                                                             std::to_string(facts.crossings),
                                                             std::to_string(facts.misoriented),
                                                             std::to_string(facts.overlapping),
                                                             std::to_string(facts.hatches),
                                                             std::to_string(image.shown),
                                                             std::to_string(image.contours_shown),
                                                             std::to_string(image.hatches_shown),
                                                             page_number(image.tolerance_mm),
                                                             std::to_string(facts.scan.vectors),
                                                             page_number(facts.scan.marked_mm),
                                                             page_number(facts.scan.jumped_mm),
                                                             page_number(facts.scan.build_seconds),
                                                             page_number(facts.scan.energy_j)};
        for (std::size_t i = 0; i < shown_; ++i)
            append(texts_[i], values[i]);
        planes_.push_back({facts.position.index, facts.measure.area_mm2});
    }

    /// Returns the table as JSON. `changes` are the changes that layer steps made to the planes. If there are
    /// none, the table has no columns about changes.
    [[nodiscard]] std::string json(const std::vector<PageChange>& changes) const {
        std::string text;
        for (std::size_t i = 0; i < shown_; ++i)
            append(text, column(columns[i], texts_[i]));
        if (!changes.empty())
            append(text, change_columns(changes));
        return "{" + text + "}";
    }

  private:
    static void append(std::string& list, std::string_view item) {
        list.append(list.empty() ? "" : ",").append(item);
    }
    static std::string column(std::string_view name, std::string_view values) {
        return fmt::format("\n\"{}\":[{}]", name, values);
    }

    [[nodiscard]] std::string change_columns(const std::vector<PageChange>& changes) const {
        std::map<std::uint64_t, LayerChanges> by_index;
        for (const PageChange& change : changes)
            by_index[change.index] += change.changes;
        std::string dropped;
        std::string before;
        for (const StoredPlane& plane : planes_) {
            const LayerChanges& change = by_index[plane.index];
            append(dropped, std::to_string(change.rings_dropped));
            // The figures cover changed parts only; unchanged parts cancel in the difference.
            append(before, page_number(plane.area_mm2 - change.area_after_mm2 + change.area_before_mm2));
        }
        return column("rings_dropped", dropped) + "," + column("area_before_mm2", before);
    }

    struct StoredPlane {
        std::uint64_t index;
        double area_mm2;
    };
    static constexpr std::size_t columns_of_scan = 5; // the last ones
    static constexpr std::array<std::string_view, 25> columns{
        "index",          "z",         "bottom",         "top",           "area_mm2",
        "perimeter_mm",   "contours",  "holes",          "points",        "open_chains",
        "longest_gap_mm", "gaps_mm",   "crossings",      "misoriented",   "overlapping",
        "hatches",        "shown",     "contours_shown", "hatches_shown", "tolerance_mm",
        "vectors",        "marked_mm", "jumped_mm",      "build_seconds", "energy_j"};
    std::size_t shown_;
    std::array<std::string, columns.size()> texts_;
    std::vector<StoredPlane> planes_;
};

class PageWriter final : public LayerPageWriter {
  public:
    PageWriter(const std::string& path, const LayerFileInfo& info, const PageOptions& options)
        : frame_(page_frame(options)), grid_(page_grid(info.box)), file_(path, Overwriting::no, info.memory),
          order_(info), parts_(info.parts), budget_(options, info.layers, has_vectors()),
          table_(has_vectors()) {
        file_.append(frame_.header);
        file_.append(json_element("head", header(info, options)));
    }

    [[nodiscard]] Commit prepare(const Plane& plane) override {
        order_.check_parts(plane);
        PlaneFacts facts{.position = plane_position(plane)};
        std::vector<Point2> positions;
        look_at(plane, parts_, facts, positions);
        return
            [this, facts, images = images_of(plane, parts_, positions, grid_, budget_.thinned())]() mutable {
                order_.next(facts.position);
                write(facts, images);
            };
    }

    void add_notes(PageNotes notes) override {
        std::move(notes.sections.begin(), notes.sections.end(), std::back_inserter(notes_.sections));
        std::move(notes.locations.begin(), notes.locations.end(), std::back_inserter(notes_.locations));
        std::move(notes.changes.begin(), notes.changes.end(), std::back_inserter(notes_.changes));
    }

    void finish() override {
        order_.end();
        file_.append(json_element("table", table_.json(notes_.changes)));
        file_.append(json_element("notes", notes_json(notes_)));
        file_.append(frame_.tail);
        file_.commit();
    }

    [[nodiscard]] std::uint64_t bytes() const noexcept override { return file_.bytes(); }

    [[nodiscard]] Findings findings() const override {
        Findings found;
        if (without_hatches_ > 0)
            found.add({.kind = FindingKind::hidden_hatch_lines,
                       .count = without_hatches_,
                       .of_layers = order_.count()});
        if (thinned_ > 0)
            found.add({.kind = FindingKind::thinned_layers,
                       .count = thinned_,
                       .largest = largest_tolerance_mm_,
                       .of_layers = order_.count(),
                       .place = not_shown_ > 0 ? fmt::format(" and {} small ones are not shown", not_shown_)
                                               : std::string()});
        return found;
    }

  private:
    [[nodiscard]] bool has_vectors() const {
        return std::any_of(parts_.begin(), parts_.end(),
                           [](const PartInfo& part) { return part.exposure.has_value(); });
    }

    [[nodiscard]] std::string header(const LayerFileInfo& info, const PageOptions& options) const {
        const auto part_json = [](const PartInfo& part) {
            return fmt::format(R"({{"label":{},"box":{}{}}})", page_quoted(part.label), page_box(part.box),
                               part.exposure ? R"(,"exposure":)" + exposure_json(*part.exposure) : "");
        };
        return fmt::format(
            R"({{"kind":"layers","version":1,"title":{},"layers":{},"step_mm":{},"origin":[{},{}],)"
            R"("box":{},"bottom":{},"budget_bytes":{},"layer_points":{},"most_marks":{},"parts":{}}})",
            page_quoted(options.title), info.layers, page_number(grid_.step_mm), grid_.origin.x,
            grid_.origin.y, page_box(info.box), page_number(info.bottom), options.budget_bytes,
            options.layer_points, most_marks, json_list(info.parts, part_json));
    }

    void write(const PlaneFacts& facts, const std::vector<Image>& images) {
        const Image& image = budget_.choose(images);
        if (image.hatches_shown < facts.hatches)
            ++without_hatches_;
        if (image.tolerance_mm > 0) {
            ++thinned_;
            largest_tolerance_mm_ = std::max(largest_tolerance_mm_, image.tolerance_mm);
            not_shown_ += facts.measure.contours - image.contours_shown;
        }
        file_.append(data_element(image.bytes));
        table_.add(facts, image);
    }

    PageFrame frame_;
    PageGrid grid_;
    AtomicFile file_;
    PlaneOrder order_;
    std::vector<PartInfo> parts_;
    Budget budget_;
    std::uint64_t without_hatches_ = 0;
    std::uint64_t thinned_ = 0;
    std::uint64_t not_shown_ = 0; ///< contours
    double largest_tolerance_mm_ = 0;
    PlaneTable table_;
    PageNotes notes_;
};

} // namespace

std::unique_ptr<LayerPageWriter> open_layer_page(const std::string& path, const LayerFileInfo& info,
                                                 const PageOptions& options) {
    return std::make_unique<PageWriter>(path, info, options);
}

} // namespace lamella
