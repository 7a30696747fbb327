#pragma once

// Where material is, by winding numbers: of one layer by a rule, of two by an operation.

#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/fill.hpp"

#include "polygon/windings.hpp"

namespace lamella {

class Material {
  public:
    /// Of one operand: its union with nothing.
    explicit Material(FillRule rule) noexcept : rule_(rule) {}
    /// `least`: how often rings of the second operand wind at least around what counts as its material.
    explicit Material(BooleanOperation operation, std::int64_t least = 1) noexcept
        : operation_(operation), least_(least) {}

    [[nodiscard]] bool operator()(const Windings& w) const noexcept {
        return made_of(of_rule(w.first), of_rule(w.second - least_ + 1));
    }
    /// Whether it is known to be everywhere or nowhere where the windings are off `around` by at most
    /// `rings`.
    [[nodiscard]] bool alike(const Windings& around, const Windings& rings) const noexcept;

  private:
    [[nodiscard]] bool of_rule(std::int64_t winding) const noexcept;
    [[nodiscard]] bool made_of(bool first, bool second) const noexcept;

    FillRule rule_ = FillRule::positive;
    BooleanOperation operation_ = BooleanOperation::unite;
    std::int64_t least_ = 1;
};

} // namespace lamella
