#include "polygon/orientation.hpp"

#include "core/exact_sum.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace lamella {

// The height of s at x times its width is lo.y hi.x - hi.y lo.x + x hi.y - x lo.y. Both sides are multiplied
// by the width of the other segment, which is positive.
int exact_compare_heights(double x, const Segment& s, const Segment& t) noexcept {
    std::array<SignedProduct<3>, 16> terms;
    std::size_t n = 0;
    const auto add = [&](const Segment& of, const Segment& other, bool minus) {
        for (const auto& [factor, negative] : {std::pair{other.hi.x, minus}, std::pair{other.lo.x, !minus}}) {
            terms[n++] = {{of.lo.y, of.hi.x, factor}, negative};
            terms[n++] = {{of.hi.y, of.lo.x, factor}, !negative};
            terms[n++] = {{x, of.hi.y, factor}, negative};
            terms[n++] = {{x, of.lo.y, factor}, !negative};
        }
    };
    add(s, t, false);
    add(t, s, true);
    return sign_of_sum(terms);
}

} // namespace lamella
