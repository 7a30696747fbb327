#include "slices/images/run_encoder.hpp"

#include <cassert>

namespace lamella {

RunEncoder::RunEncoder(const RunCode& code, ByteBuffer& out)
    : code_(code), out_(out), begin_(out.view().size()) {
    out_.append(code_.begin);
}

void RunEncoder::put() {
    if (length_ == 0)
        return;
    code_.put(value_, length_, out_);
    lit_ += value_ == 0 ? 0 : length_;
}

void RunEncoder::add(std::span<const PixelRun> row, std::uint32_t times) {
    assert(!row.empty());
    if (row.size() == 1) {
        add(code_.joined[row.front().value], std::uint64_t{row.front().end} * times);
        return;
    }
    for (std::uint32_t i = 0; i < times; ++i) {
        std::uint32_t from = 0;
        for (const PixelRun& run : row) {
            add(code_.joined[run.value], run.end - from);
            from = run.end;
        }
    }
}

void RunEncoder::finish() {
    put();
    length_ = 0;
    if (code_.close != nullptr)
        code_.close(begin_, out_);
}

} // namespace lamella
