#pragma once

// Findings: defects of meshes and layers, and contents that are lost on the way to a file. One table has all
// kinds of findings; containers count them.

#include "lamella/core/api.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Kinds of findings, in the order in which they are reported. Each has a row in finding_kinds().
enum class FindingKind : std::uint32_t {
    open_chains,    ///< contours that do not close, in layers of a mesh
    inverted_rings, ///< rings that bound no material, in layers of a mesh

    // Found by checks of layers and scan vectors.
    open_contours,         ///< contours that are not closed
    contour_gaps,          ///< gaps between the ends of open contours
    crossings,             ///< pairs of segments that cross properly; touching is allowed
    misoriented_rings,     ///< clockwise rings outside of material
    tangled_rings,         ///< rings of positive area that bound no material
    overlapping_rings,     ///< counter-clockwise rings within material: of overlapping bodies, or wrong holes
    outside_vectors,       ///< vectors that leave the material
    misplaced_vectors,     ///< vectors nearer to its edges than the strategy allows, or outside
    short_lines,           ///< hatch lines below `shortest`
    unreached_layers,      ///< planes where the material without vectors is more than the strategy accepts
    rings_without_vectors, ///< rings of the mesh's sections that bound no material and so get no vectors
    no_vectors,            ///< there is a strategy but no vector
    height_overlaps,       ///< layers that begin within the height of another one
    unchecked_hatch_lines, ///< lines that are not checked, because no contour bounds their area
    uncompared_layers,     ///< layers that are not compared with the mesh, because contours are open
    other_areas,           ///< layers whose area differs from that of the mesh's section
    displaced_layers,      ///< layers whose area agrees but whose centroid differs
    mirrored_images,       ///< images that show the part of the mesh mirrored
    moved_images,          ///< images that show it elsewhere than the mesh has it

    near_faces, ///< horizontal faces that are on a plane except for rounding

    layer_gaps,        ///< gaps between consecutive layers where the mesh has material
    unbounded_vectors, ///< vectors whose material is unknown: neither a mesh nor a closed outer contour

    dropped_open_chains,  ///< contours of a slice file of which no scan vectors can be made
    reversible_rings,     ///< inverted rings of a slice file
    replaced_hatch_lines, ///< lines of a slice file that new ones replace
    outdated_hatch_lines, ///< lines of a slice file whose contours were changed
    nothing_left,         ///< no contour is left after the steps
    no_contours,          ///< no layer has a contour, although no step removed them
    unreached_material,   ///< material that no scan vector reaches
    overlapping_parts,    ///< material of several parts, which scan vectors expose several times

    // Found by the check of a print.
    unchecked_chains, ///< open contours, whose material is unknown
    islands,          ///< material that begins without material below it
    loose_supports,   ///< the same of parts that are supports
    overhangs,        ///< areas that the layer below does not carry
    cups,             ///< spaces that are enclosed while they are printed
    traps,            ///< spaces that remain enclosed
    empty_layers,     ///< layers without material between layers with material
    area_jumps,       ///< layers with a much larger area than the layer below

    // Content that the format of an output cannot hold.
    rounded_points,        ///< contours whose points are moved noticeably; the amount is the merged points
    vanished_contours,     ///< contours without any point after rounding
    vanished_hatch_lines,  ///< hatch lines that rounding shrinks to a point
    rounded_heights,       ///< heights of layers that are moved noticeably
    unwritten_chains,      ///< open contours
    unwritten_hatch_lines, ///< hatch lines
    unwritten_gaps,        ///< layers that do not begin at the top of the previous layer
    changed_labels,        ///< labels of parts with characters or a length that the file cannot have
    unwritten_labels,      ///< labels of parts
    unmarked_supports,     ///< parts that are supports
    unwritten_parameters,  ///< parts with parameters of scan vectors
    changed_parameters,    ///< exposures that lose a parameter that differs from its default
    unknown_parameters,    ///< parts without parameters of scan vectors, which the format requires
    unseen_material,       ///< layers with material too thin for the pixels of their images
    bottom_cuts,           ///< layers that were cut at their bottom
    top_cuts,              ///< layers that were cut at their top
    other_cuts,            ///< layers that were cut elsewhere than there or in the middle
    hidden_hatch_lines,    ///< layers of a page that are shown without their hatches
    thinned_layers,        ///< layers of a page that are shown with fewer points
    unwritten_settings,    ///< settings of a job for a resin printer
    changed_pixels,        ///< pixels of images whose grey value the format or the display does not have
    flattened_triangles,   ///< triangles of a mesh that lose their area or a corner by rounding

    // Irregularities of a slice file, and how its reader treated them.
    unclosed_rings,         ///< closed contours without their first point at the end
    contours_with_gaps,     ///< contours with gaps (SLC)
    open_polylines,         ///< open contours where a format expects closed ones
    returning_chains,       ///< open contours that end where they begin
    reversed_by_direction,  ///< contours that ran against their stated direction
    outside_outlines,       ///< outlines of SVG outside of layers
    other_elements,         ///< elements of SVG that are no outlines
    unfollowed_transforms,  ///< elements of SVG with transforms
    reversed_by_rule,       ///< contours that ran against their type or fill rule
    unsorted_rings,         ///< paths with too many rings for their fill rule
    objects_without_slices, ///< objects of a build without slices
    no_solids,              ///< objects that are no solids
    items_not_printed,      ///< items that are not to be printed
    other_block_counts,     ///< work planes with another number of blocks
    other_plane_numbers,    ///< work planes whose number is not the one after the previous number
    moved_planes,           ///< work planes that are moved or rotated
    other_vectors,          ///< blocks with vectors that are not read
    repeated_blocks,        ///< blocks to be executed more than once
    repeated_planes,        ///< work planes to be executed more than once
    blocks_of_lasers,       ///< blocks for another laser than the first
    segments_of_lasers,     ///< segments for another laser than the first
    unknown_names,          ///< files of an ILT archive whose name says nothing of their vectors
    halves_of_settings,     ///< files with a speed or a power only
    pulsed_beams,           ///< files for a pulsed beam
    unlisted_files,         ///< files that are not in the list of an archive
    dropped_contours,       ///< contours with too few different points
    unknown_commands,       ///< commands that are unknown
    missing_pixels,         ///< images that lack their last pixel
};

enum class Severity : std::uint8_t {
    note,    ///< information; never an error
    warning, ///< an error with `strict`
    defect,  ///< a check of layers or scan vectors fails
};

/// The cause of a finding. For defects of a mesh, programs refer to `lamella info`.
enum class FindingOrigin : std::uint8_t {
    mesh,              ///< a defect of the mesh
    job,               ///< an option of the job, or content of a slice file
    layers,            ///< found by the check of layers
    vectors,           ///< found by the check of scan vectors
    layers_or_vectors, ///< found by both checks
    print,             ///< found by the check of a print
    output,            ///< lost on the way to a file
    input,             ///< an irregularity of a slice file that was read
};

struct Finding;

/// A row of the table of findings. Texts are templates of {fmt} with these fields: `{count}`, `{amount}`,
/// `{largest}`, `{first_layer}` (numbers of the finding), `{z}` (Finding::first_z), `{or_more}` (a clause if
/// Finding::or_more), `{place}` (see Finding), `{where}` ("in 3 of 20 layers, first at z = 0.25 mm"),
/// `{on_layers}` ("on 3 layers, the lowest at z = 0.25 mm"), `{layers}` ("20 layers": all of them),
/// `{affected}` (the number of layers with the finding), and `{cure}`, the text of the function `cure`.
struct FindingDescription {
    FindingKind kind = {};
    const char* name = ""; ///< for programs, such as "open_chains"
    Severity severity = Severity::warning;
    FindingOrigin origin = FindingOrigin::job;
    const char* one = "";  ///< text if the count is 1
    const char* many = ""; ///< text for other counts
    /// Unit of the amount over all layers: "mm" or "mm2"; "mm3" if the areas of layers are multiplied by the
    /// thickness of the layers; "" if there is no amount.
    const char* unit = "";
    /// Names of the numbers in JSON; "" for numbers that are not written. The amount of one layer and the
    /// amount of all layers have different names if their units differ.
    const char* count_key = "";
    const char* amount_key = "";
    const char* layer_amount_key = "";
    const char* largest_key = "";
    /// Returns a cause or a cure that depends on the numbers; null if the templates need none.
    std::string (*cure)(const Finding& finding) = nullptr;
};

/// Returns the row of each kind, in the order of the kinds.
[[nodiscard]] std::span<const FindingDescription> finding_kinds() noexcept;
[[nodiscard]] const FindingDescription& description(FindingKind kind) noexcept;

/// The finding of one kind in one part on one plane. Has no padding, so that processes can send it.
struct PlaneFinding {
    FindingKind kind = {};
    std::uint32_t file = 0;   ///< index of the input
    std::uint32_t part = 0;   ///< index of the part, or no_part
    std::uint32_t unused = 0; ///< fills the place of padding; always 0
    std::uint64_t plane = 0;  ///< index of the plane
    std::uint64_t count = 0;  ///< number of chains, rings, and so on
    double amount = 0;        ///< sum of their lengths in mm, or areas in mm2
    double largest = 0;       ///< the largest length, in mm

    /// The value of `part` in findings that belong to no part.
    static constexpr std::uint32_t no_part = ~std::uint32_t{0};

    /// Adds the numbers of another finding of the same kind on the same plane.
    void add(const PlaneFinding& other) noexcept;

    friend bool operator==(const PlaneFinding&, const PlaneFinding&) = default;
};

/// The finding of one kind in one file, or in all files, over all layers.
struct Finding {
    FindingKind kind = {};
    std::uint32_t file = 0;                ///< index of the input, or all_files
    std::vector<std::string> entries = {}; ///< if the file is an archive: its files with the finding
    std::uint64_t count = 0;
    bool or_more = false;                ///< the search ended at this count
    double amount = 0;                   ///< in the unit of the kind
    double largest = 0;                  ///< mm
    std::uint64_t layers = 0;            ///< number of layers with the finding
    std::uint64_t of_layers = 0;         ///< number of all layers
    double first_z = 0;                  ///< height of the lowest of these layers, mm
    std::uint64_t first_layer = 0;       ///< index of that layer, if the source of the finding sets it
    std::vector<std::string> parts = {}; ///< labels of the parts with the finding; empty if all parts have it
    /// Text about the first one: its location, such as "byte 120", and what was found there.
    std::string place = {};

    /// The value of `file` in findings that belong to no single file.
    static constexpr std::uint32_t all_files = ~std::uint32_t{0};

    /// Returns one line with the finding, its position and a remedy. Options are named as fields between
    /// backquotes, such as `orient`. The first of the `entries`, if any, is put in front of it.
    [[nodiscard]] std::string text() const;

    friend bool operator==(const Finding&, const Finding&) = default;
};

/// Height and thickness of a plane, for sums over planes.
struct PlaneHeight {
    double z = 0;
    double thickness = 0;
};

/// A number of findings and its key in JSON.
struct FindingNumber {
    const char* key = "";
    std::variant<std::uint64_t, double> value; ///< a count or an amount
};

/// Findings of a job, or of a step of it, such as reading a file.
struct Findings {
    std::vector<Finding> by_file; ///< by ascending kind, then file, then entries
    std::vector<Finding> total;   ///< over all files, by ascending kind

    [[nodiscard]] bool empty() const noexcept { return by_file.empty(); }
    /// Returns the finding of a kind over all files; its count is 0 if there is none.
    [[nodiscard]] const Finding& of(FindingKind kind) const noexcept;
    /// Returns the finding of a kind in a file; its count is 0 if there is none.
    [[nodiscard]] const Finding& of(FindingKind kind, std::uint32_t file) const noexcept;
    [[nodiscard]] std::uint64_t count(FindingKind kind) const noexcept { return of(kind).count; }
    /// Returns the first finding whose severity is at least `least`; null if there is none.
    [[nodiscard]] const Finding* first(Severity least) const noexcept;
    /// Returns the numbers of all kinds of a check, `layers`, `vectors` or `print`, that have keys, in the
    /// order of the table. Kinds with the same key are added up; numbers of kinds that were not found are 0.
    [[nodiscard]] std::vector<FindingNumber> numbers(FindingOrigin check) const;
    /// Returns a line for each finding, without the names of files.
    [[nodiscard]] std::vector<std::string> texts() const;
    /// Adds a finding, also to the total of its kind. If there already is a finding of this kind, file and
    /// entries, adds the numbers to it. The added finding must then be about later layers, or a later range
    /// of the file.
    void add(Finding finding);
    /// Adds the findings of other files, or of later layers or ranges.
    void add(const Findings& others);
    /// Counts findings of file 0. `place()`, the text Finding::place, is called only for the first of its
    /// kind.
    template <class Place>
    void note(FindingKind kind, const Place& place, std::uint64_t count = 1) {
        if (!count_again(kind, count))
            add({.kind = kind, .count = count, .place = std::string(place())});
    }

  private:
    /// Adds to the count of a kind in file 0. Returns false if there is none.
    bool count_again(FindingKind kind, std::uint64_t count) noexcept;
};

/// Collects findings on planes, from any threads.
class FindingLog {
  public:
    FindingLog() = default;
    FindingLog(const FindingLog&) = delete;
    FindingLog& operator=(const FindingLog&) = delete;

    /// Adds findings; those with a count of 0 are ignored. O(found).
    void add(std::span<const PlaneFinding> found);
    void add(const PlaneFinding& found) { add({&found, 1}); }
    /// Returns and removes all findings that were added.
    [[nodiscard]] std::vector<PlaneFinding> take();
    /// Returns sums over planes, which do not depend on the order of `add`. `planes` are the heights of all
    /// planes, `labels` the labels of all parts, `files` the file of each part. O(n log n).
    [[nodiscard]] Findings sums(std::span<const PlaneHeight> planes, std::span<const std::string> labels = {},
                                std::span<const std::uint32_t> files = {}) const;
    /// Returns the findings on each plane: the sum over all parts, by ascending plane and kind. O(n log n).
    [[nodiscard]] std::vector<PlaneFinding> by_plane() const;

  private:
    [[nodiscard]] std::vector<PlaneFinding> sorted() const;

    mutable std::mutex mutex_;
    std::vector<PlaneFinding> found_; ///< in any order
};

} // namespace lamella
LAMELLA_API_END
