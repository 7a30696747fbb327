#pragma once

// Memory for points.

#include "lamella/core/point.hpp"

#include "core/pages.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace lamella {

/// Memory for the points of layers, in blocks that live as long as a layer uses them. Blocks are large, so
/// that they lie in large pages; only what is touched of them takes memory. A block that its layers let go of
/// while slicing goes on is used again: memory that was written before costs a fraction of fresh memory.
class PointArena {
  public:
    /// `expected`: the points of the whole result; small results take small blocks.
    explicit PointArena(std::uint64_t expected)
        : usual_(std::min(expected, largest_usual)), returned_(std::make_shared<Returned>()) {}

    struct Piece {
        std::shared_ptr<const void> owner;
        Point2* points;
    };

    [[nodiscard]] Piece take(std::uint64_t size) {
        if (!block_ || block_->memory.size() - used_ < size) {
            block_.reset();
            block_ = std::make_shared<Block>(find_memory(size), returned_);
            used_ = 0;
        }
        Point2* points = block_->memory.data() + used_;
        used_ += size;
        assert(used_ <= block_->memory.size());
        return {block_, points};
    }

  private:
    static constexpr std::uint64_t largest_usual = (std::uint64_t{8} << 20) / sizeof(Point2);

    struct Returned {
        std::mutex mutex;
        std::vector<PageArray<Point2>> memory;
    };

    struct Block {
        Block(PageArray<Point2> points, const std::shared_ptr<Returned>& to)
            : memory(std::move(points)), returned(to) {}
        ~Block() {
            if (const std::shared_ptr<Returned> to = returned.lock()) {
                const std::lock_guard lock(to->mutex);
                to->memory.push_back(std::move(memory));
            }
        }
        Block(const Block&) = delete;
        Block& operator=(const Block&) = delete;

        PageArray<Point2> memory;
        std::weak_ptr<Returned> returned; ///< gone when slicing is over: then the memory goes too
    };

    PageArray<Point2> find_memory(std::uint64_t size) {
        {
            const std::lock_guard lock(returned_->mutex);
            for (PageArray<Point2>& memory : returned_->memory) {
                if (memory.size() < size)
                    continue;
                PageArray<Point2> found = std::move(memory);
                memory = std::move(returned_->memory.back());
                returned_->memory.pop_back();
                return found;
            }
            returned_->memory.clear(); // all too small by now
        }
        return PageArray<Point2>(std::max(size + size / 8, usual_));
    }

    std::uint64_t usual_;
    std::shared_ptr<Returned> returned_;
    std::shared_ptr<Block> block_;
    std::uint64_t used_ = 0;
};

} // namespace lamella
