#include "system/mapped_file.hpp"

#include "system/windows/calls.hpp"

#include <new>

namespace lamella {

MappedFile::MappedFile(const NativeFile& file, std::size_t bytes) : size_(bytes) {
    // A temporary file is removed when its last handle is closed, which must come after the view.
    HANDLE copy = INVALID_HANDLE_VALUE;
    if (DuplicateHandle(GetCurrentProcess(), handle_of(file), GetCurrentProcess(), &copy, 0, FALSE,
                        DUPLICATE_SAME_ACCESS) == 0)
        throw std::bad_alloc();
    kept_open_ = owner_of(copy);
    const HANDLE mapping = CreateFileMappingW(handle_of(file), nullptr, PAGE_READONLY, 0, 0, nullptr);
    if (mapping == nullptr)
        throw std::bad_alloc();
    void* const data = MapViewOfFile(mapping, FILE_MAP_READ, 0, 0, bytes);
    CloseHandle(mapping);
    if (data == nullptr)
        throw std::bad_alloc();
    data_ = static_cast<std::byte*>(data);
}

MappedFile::~MappedFile() {
    UnmapViewOfFile(data_);
}

void release_mapped(std::span<const std::byte> /*from_start*/, std::span<const std::byte> range) noexcept {
    // Unlocking pages that are not locked removes them from the working set.
    VirtualUnlock(const_cast<std::byte*>(range.data()), range.size());
}

} // namespace lamella
