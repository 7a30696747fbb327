#pragma once

#include "lamella/core/point.hpp"

#include "core/pages.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace lamella {

/// Memory for the points of layers. It is allocated in large areas, which can use large pages; pages that are
/// never written take no memory. An area lives as long as a layer uses it. If its layers are released during
/// slicing, it is reused, because writing to used memory costs a fraction of writing to fresh memory.
class PointArena {
  public:
    /// Expects this many points in the whole result; small results get small areas.
    explicit PointArena(std::uint64_t expected)
        : usual_(std::min(expected, largest_usual)), returned_(std::make_shared<Returned>()) {}

    struct Piece {
        std::shared_ptr<const void> owner;
        Point2* points;
    };

    [[nodiscard]] Piece take(std::uint64_t size) {
        if (!block_ || block_->memory.front().size() - used_ < size) {
            block_.reset();
            block_ = std::make_shared<Block>(find_memory(size), returned_);
            used_ = 0;
        }
        Point2* points = block_->memory.front().data() + used_;
        used_ += size;
        assert(used_ <= block_->memory.front().size());
        return {block_, points};
    }

  private:
    static constexpr std::uint64_t largest_usual = (std::uint64_t{8} << 20) / sizeof(Point2);

    /// A list, because moving an element between lists allocates nothing: a destructor returns the memory.
    using Memory = std::list<PageArray<Point2>>;

    struct Returned {
        std::mutex mutex;
        Memory memory;
    };

    struct Block {
        Block(Memory one, const std::shared_ptr<Returned>& to) : memory(std::move(one)), returned(to) {}
        ~Block() {
            if (const std::shared_ptr<Returned> to = returned.lock()) {
                const std::lock_guard lock(to->mutex);
                to->memory.splice(to->memory.end(), memory);
            }
        }
        Block(const Block&) = delete;
        Block& operator=(const Block&) = delete;

        Memory memory;                    ///< a single array
        std::weak_ptr<Returned> returned; ///< expired after slicing; then the memory is freed
    };

    Memory find_memory(std::uint64_t size) {
        Memory found;
        {
            const std::lock_guard lock(returned_->mutex);
            Memory& returned = returned_->memory;
            const auto large = std::find_if(returned.begin(), returned.end(),
                                            [&](const auto& memory) { return memory.size() >= size; });
            if (large != returned.end()) {
                found.splice(found.end(), returned, large);
                return found;
            }
            returned.clear(); // all are too small now
        }
        found.emplace_back(std::max(size + size / 8, usual_));
        return found;
    }

    std::uint64_t usual_;
    std::shared_ptr<Returned> returned_;
    std::shared_ptr<Block> block_;
    std::uint64_t used_ = 0;
};

} // namespace lamella
