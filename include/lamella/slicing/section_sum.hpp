#pragma once

// Section areas of meshes that stream by.

#include "lamella/core/point.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <memory>
#include <vector>

namespace lamella {

/// Adds up `section_areas` batch by batch, in the memory of some numbers for each plane and thread.
class SectionSum {
  public:
    /// Areas are measured about `middle`, best that of the whole mesh, so that no digits are lost far from
    /// it.
    SectionSum(const Plan& plan, const Point3& middle);
    ~SectionSum();
    SectionSum(const SectionSum&) = delete;
    SectionSum& operator=(const SectionSum&) = delete;

    /// On the calling thread; from any number of threads at once.
    void add(const Mesh& batch);
    /// Of all batches together, in mm^2; the last digits depend on who added what.
    [[nodiscard]] std::vector<double> areas() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lamella
