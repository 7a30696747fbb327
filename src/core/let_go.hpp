#pragma once

#include <vector>

namespace lamella {

/// Gives the memory of a list back: `items = {}` would empty it and keep that.
template <class T>
void let_go(std::vector<T>& items) noexcept {
    std::vector<T>().swap(items);
}

} // namespace lamella
