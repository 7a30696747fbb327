#include "polygon/material.hpp"

#include <cstdlib>

namespace lamella {

bool Material::alike(const Windings& around, const Windings& rings) const noexcept {
    const auto known = [this](std::int64_t w, std::int64_t off) {
        return off == 0 || (rule_ != FillRule::evenodd && std::abs(w) > off);
    };
    const bool first = of_rule(around.first);
    const std::int64_t beyond = around.second - least_ + 1;
    const bool second = of_rule(beyond);
    const bool here = made_of(first, second);
    const bool first_known = known(around.first, rings.first);
    const bool second_known = known(beyond, rings.second);
    return (first_known || made_of(!first, second) == here) &&
           (second_known || made_of(first, !second) == here) &&
           (first_known || second_known || made_of(!first, !second) == here);
}

bool Material::of_rule(std::int64_t winding) const noexcept {
    switch (rule_) {
    case FillRule::nonzero:
        return winding != 0;
    case FillRule::evenodd:
        return winding % 2 != 0;
    default:
        return winding > 0;
    }
}

bool Material::made_of(bool first, bool second) const noexcept {
    switch (operation_) {
    case BooleanOperation::intersect:
        return first && second;
    case BooleanOperation::subtract:
        return first && !second;
    case BooleanOperation::exclude:
        return first != second;
    default:
        return first || second;
    }
}

} // namespace lamella
