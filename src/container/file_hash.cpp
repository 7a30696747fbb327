#include "lamella/container/file_hash.hpp"

#include "lamella/core/error.hpp"

#include "core/pages.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>

namespace lamella {

namespace {

struct FreeState {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

} // namespace

std::uint64_t file_hash(const std::string& path, const Execution& execution) {
    const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
    if (!state)
        throw std::bad_alloc();
    XXH3_64bits_reset(state.get());
    const ByteSource source = open_bytes(path, execution, memory_of_file(0),
                                         [](std::span<const std::byte>, std::uint64_t) { return true; });
    constexpr std::uint64_t at_once = std::uint64_t{1} << 20;
    const PageArray<std::byte> window(std::min(at_once, source.size()));
    for (std::uint64_t at = 0; at < source.size(); at += at_once) {
        if (execution.cancelled())
            throw Error(ErrorKind::cancelled, "cancelled");
        const std::span<std::byte> chunk = window.span().first(std::min(at_once, source.size() - at));
        copy_out(source, at, chunk);
        XXH3_64bits_update(state.get(), chunk.data(), chunk.size());
    }
    return XXH3_64bits_digest(state.get());
}

} // namespace lamella
