#include "lamella/container/file_hash.hpp"

#include "lamella/core/error.hpp"

#include "core/byte_source.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <memory>
#include <new>

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
    const ByteSource source = open_bytes(path, execution);
    constexpr std::size_t at_once = std::size_t{1} << 22;
    for (std::size_t at = 0; at < source.bytes.size(); at += at_once) {
        if (execution.cancelled())
            throw Error(ErrorKind::cancelled, "cancelled");
        const auto piece = source.bytes.subspan(at, std::min(at_once, source.bytes.size() - at));
        XXH3_64bits_update(state.get(), piece.data(), piece.size());
        release(source, piece);
    }
    check_length(source);
    return XXH3_64bits_digest(state.get());
}

} // namespace lamella
