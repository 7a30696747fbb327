#pragma once

// Defines material by the winding numbers of one layer and a rule, or by the winding numbers of two layers
// and an operation.

#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/fill.hpp"

#include "polygon/windings.hpp"

namespace lamella {

class Material {
  public:
    /// Defines the material of one operand.
    explicit Material(FillRule rule) noexcept : rule_(rule) {}
    /// `least` is the smallest winding number of the second operand that counts as its material.
    explicit Material(BooleanOperation operation, std::int64_t least = 1) noexcept
        : operation_(operation), least_(least) {}

    [[nodiscard]] bool operator()(const Windings& w) const noexcept {
        return made_of(of_rule(w.first), of_rule(w.second - least_ + 1));
    }
    /// Returns whether the winding numbers that differ from `around` by at most `rings` all have material, or
    /// all have none.
    [[nodiscard]] bool alike(const Windings& around, const Windings& rings) const noexcept;

  private:
    [[nodiscard]] bool of_rule(std::int64_t winding) const noexcept;
    [[nodiscard]] bool made_of(bool first, bool second) const noexcept;

    FillRule rule_ = FillRule::positive;
    BooleanOperation operation_ = BooleanOperation::unite;
    std::int64_t least_ = 1;
};

} // namespace lamella
