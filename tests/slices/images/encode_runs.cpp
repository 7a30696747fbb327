// Encodes images for tests that have images of other programs. Reads images from standard input: a letter for
// the code (g: goo, c: ctb, p: pw0, b: black and white), width, height, number of runs, and the runs, a value
// and a length each; numbers have 32 bits, values 8. Writes the number of bytes and the bytes of each image.

#include "slices/images/run_codes.hpp"

#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

std::uint32_t read_number() {
    std::uint32_t number = 0;
    return std::fread(&number, sizeof number, 1, stdin) == 1 ? number : 0;
}

lamella::RunCode code_named(int letter) {
    switch (letter) {
    case 'g':
        return lamella::goo_runs();
    case 'c':
        return lamella::ctb_runs();
    case 'p':
        return lamella::pw0_runs();
    default:
        return lamella::bit_runs(128);
    }
}

/// Adds runs to the encoder, divided into rows.
class RowsOfRuns {
  public:
    RowsOfRuns(lamella::RunEncoder& encoder, std::uint32_t width) : encoder_(encoder), width_(width) {}

    void add(std::uint8_t value, std::uint32_t length) {
        while (length > 0) {
            const std::uint32_t begin = row_.empty() ? 0 : row_.back().end;
            const std::uint32_t here = length < width_ - begin ? length : width_ - begin;
            row_.push_back({begin + here, value});
            length -= here;
            if (begin + here < width_)
                return;
            encoder_.add(row_, 1);
            row_.clear();
        }
    }

  private:
    lamella::RunEncoder& encoder_;
    std::uint32_t width_;
    std::vector<lamella::PixelRun> row_;
};

} // namespace

int main() {
    for (int letter = std::getchar(); letter != EOF; letter = std::getchar()) {
        const lamella::RunCode code = code_named(letter);
        const std::uint32_t width = read_number();
        static_cast<void>(read_number()); // the runs end at the last row
        const std::uint32_t runs = read_number();
        lamella::ByteBuffer out;
        lamella::RunEncoder encoder(code, out);
        RowsOfRuns rows(encoder, width);
        for (std::uint32_t i = 0; i < runs; ++i) {
            const int value = std::getchar();
            rows.add(static_cast<std::uint8_t>(value), read_number());
        }
        encoder.finish();
        const auto size = static_cast<std::uint32_t>(out.view().size());
        std::fwrite(&size, sizeof size, 1, stdout);
        std::fwrite(out.view().data(), 1, size, stdout);
    }
}
