#pragma once

#include <vector>

namespace lamella {

/// Frees the memory of a list: `items = {}` would empty it but keep its memory.
template <class T>
void let_go(std::vector<T>& items) noexcept {
    std::vector<T>().swap(items);
}

} // namespace lamella
