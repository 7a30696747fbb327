#pragma once

// Layers of one slab of a plate whose files are read by several ranks, a share by each.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/pipeline/ranks.hpp"
#include "lamella/read/mesh_input.hpp"
#include "lamella/slicing/slabs.hpp"

#include "pipeline/layer_source.hpp"
#include "pipeline/stopwatch.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// All ranks make one of the same job, and call the same of its functions in the same order; the files can be
/// shared out (see MeshInput::records).
class RankSource final : public LayerSource {
  public:
    RankSource(const FileJob& job, std::vector<MeshInput> files, Communicator& ranks,
               const Execution& execution);

    [[nodiscard]] std::uint64_t triangles(std::size_t shape) const override;
    [[nodiscard]] Plan adaptive_plan(const AdaptiveLayers& layers, const Execution& execution) override;
    [[nodiscard]] PlaneCounts counts(const Plan& plan, const Execution& execution) override;
    void prepare(const FileJob& job, const Engine& with, FileResult& result,
                 const Execution& execution) override;

    /// After `counts`. Each rank gets the triangles that its slab of the plan needs; the other way round, its
    /// share of the files is let go of.
    void share_out(const Plan& plan, std::span<const PlaneRange> slabs, const Execution& execution);

    /// After share_out; the plan is that of the rank's slab.
    void slice_to(const PlateSink& sink, const Plan& plan, const Execution& execution, FileResult& result,
                  const Engine& with) override;

    [[nodiscard]] double mesh_volume() const noexcept { return mesh_volume_; }
    /// Those of reading and exchanging.
    [[nodiscard]] const RankFigures& figures() const noexcept { return figures_; }

  private:
    struct File {
        MeshInput input;
        RecordRange share;
        std::uint64_t triangles = 0; ///< usable ones, of all shares
        Point3f first_corner;
    };
    using Outgoing = std::vector<std::vector<Triangle3f>>; ///< by rank

    void look_at(const FileJob& job, const Execution& execution);
    template <class Body>
    void for_batches(const Execution& execution, const Body& body);
    [[nodiscard]] TriangleSoup exchanged(const Outgoing& outgoing);
    [[nodiscard]] const Transform& placement(std::size_t shape) const;

    Communicator& ranks_;
    bool measure_volume_;
    MeshReadOptions reading_;
    std::vector<File> files_;
    std::vector<PlaneCounts> counts_; ///< by shape, of all ranks
    double mesh_volume_ = 0;
    RankFigures figures_;
};

} // namespace lamella
