#pragma once

#include <vector>

namespace lamella {

/// Empties a container and frees its memory; `items = {}` would keep the memory.
template <class T>
void let_go(std::vector<T>& items) noexcept {
    std::vector<T>().swap(items);
}

} // namespace lamella
