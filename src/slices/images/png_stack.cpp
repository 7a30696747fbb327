#include "slices/images/png_stack.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "slices/images/png_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace lamella {

namespace {

std::string name_in(const ZipReader& archive, const ZipEntry& image) {
    return fmt::format("{}, {}", archive.name(), printable(image.name, 100));
}

std::optional<std::uint64_t> number_of(std::string_view name, std::string_view begin) {
    constexpr std::string_view ending = ".png";
    constexpr std::size_t most_digits = 9;
    if (!name.starts_with(begin) || !name.ends_with(ending) || name.size() <= begin.size() + ending.size())
        return std::nullopt;
    name.remove_prefix(begin.size());
    name.remove_suffix(ending.size());
    std::uint64_t number = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (failure != std::errc() || end != name.data() + name.size() || name.size() > most_digits)
        return std::nullopt;
    return number;
}

} // namespace

PngStack::PngStack(const ZipReader& archive, std::vector<const ZipEntry*> images)
    : archive_(archive), images_(std::move(images)) {
    if (!images_.empty()) {
        const auto [columns, rows] = size_of_image(archive_, *images_.front());
        decoding_bytes_ = (std::uint64_t{columns} + 1) * rows;
    }
    for (const ZipEntry* const image : images_)
        decoding_bytes_ = std::max(decoding_bytes_, image->size);
}

void PngStack::decode(std::size_t layer, RunBuilder& image, ReadLimits& limits) const {
    const ZipEntry& entry = *images_[layer];
    const ByteSource file = unpacked_entry(archive_, entry, limits);
    decode_png(file.text(),
               fmt::format("{}, layer {}, {}", archive_.name(), layer, printable(entry.name, 100)), image,
               limits);
}

std::string PngStack::place(std::size_t layer) const {
    return printable(images_[layer]->name, 100);
}

std::vector<const ZipEntry*> numbered_images(const ZipReader& archive, std::string_view begin,
                                             std::uint64_t first) {
    std::vector<std::pair<std::uint64_t, const ZipEntry*>> found;
    for (const ZipEntry& entry : archive.entries())
        if (const std::optional<std::uint64_t> number = number_of(entry.name, begin))
            found.emplace_back(*number, &entry);
    std::sort(found.begin(), found.end());
    std::vector<const ZipEntry*> images;
    for (const auto& [number, entry] : found) {
        if (number != first + images.size())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found the image {}; number {} is expected", archive.name(),
                                    printable(entry->name, 100), first + images.size()));
        images.push_back(entry);
    }
    if (images.empty())
        throw Error(ErrorKind::input, fmt::format("{}: found no images of layers; {}{}.png is expected",
                                                  archive.name(), printable(begin, 100), first));
    return images;
}

AlongXY<std::uint32_t> size_of_image(const ZipReader& archive, const ZipEntry& image) {
    constexpr std::size_t header_bytes = 33;
    return png_size(archive.first_bytes(image, header_bytes), name_in(archive, image));
}

std::string text_of_entry(const ZipReader& archive, std::string_view name, ReadLimits& limits) {
    const ZipEntry* const entry = archive.find(name);
    return entry == nullptr ? std::string() : std::string(unpacked_entry(archive, *entry, limits).text());
}

} // namespace lamella
