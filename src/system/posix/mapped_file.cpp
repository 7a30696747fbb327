#include "system/mapped_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <new>

namespace lamella {

MappedFile::MappedFile(const NativeFile& file, std::size_t bytes) : size_(bytes) {
    void* const data = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, static_cast<int>(file.handle()), 0);
    if (data == MAP_FAILED)
        throw std::bad_alloc();
    ::madvise(data, bytes, MADV_SEQUENTIAL);
    data_ = static_cast<std::byte*>(data);
}

MappedFile::~MappedFile() {
    ::munmap(data_, size_);
}

void release_mapped(std::span<const std::byte> from_start, std::span<const std::byte> range) noexcept {
    // Other readers may be using the first and the last page of the range. These pages are then read again.
    static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t first = (from_start.size() - range.size()) / page * page; // mappings begin with a page
    if (first < from_start.size())
        ::madvise(const_cast<std::byte*>(from_start.data()) + first, from_start.size() - first,
                  MADV_DONTNEED);
}

} // namespace lamella
