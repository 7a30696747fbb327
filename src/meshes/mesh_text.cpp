#include "meshes/mesh_text.hpp"

#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace lamella {

/// Elements that one thread reads.
struct ElementRun {
    std::size_t begin;
    std::size_t end;
    std::size_t count;
    std::size_t first = 0;
    std::size_t read = 0;
    std::size_t stop = 0; ///< where reading ended
};

namespace {

/// A window of the text.
struct Window {
    std::size_t begin = 0; ///< of the first element in it
    std::size_t end = 0;   ///< its end, or that of the list
    bool ends_list = false;
    std::size_t count = 0;   ///< of elements that begin in it
    std::uint64_t lines = 0; ///< number of line ends
};

template <class Item>
Window window_of(std::string_view text, std::size_t from, std::size_t to, const MeshTextKind<Item>& kind) {
    Window window{.end = to};
    const std::string_view searched = text.substr(0, to);
    for (std::size_t at = searched.find('<', from); at < to; at = searched.find('<', at + 1)) {
        if (same_name(text.substr(at, kind.end_of_list.size()), kind.end_of_list)) {
            window.end = at;
            window.ends_list = true;
            break;
        }
        if (same_name(text.substr(at, kind.tag.size()), kind.tag) && window.count++ == 0)
            window.begin = at;
    }
    window.lines = line_at(text.substr(from), window.end - from) - 1;
    return window;
}

/// Returns the windows from `position` to the end of the list; none if it has no end.
template <class Item>
std::vector<Window> windows_of(std::string_view text, std::size_t position, const MeshTextKind<Item>& kind,
                               Executor& executor) {
    std::vector<Window> windows;
    // Most lists are short. Of a long one, all threads search several windows before the next ones.
    std::size_t ahead = 1;
    for (std::size_t at = position; at < text.size();) {
        std::vector<Window> next(std::min((text.size() - at) / text_chunk_bytes + 1, ahead));
        executor.for_chunks(next.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            const std::size_t from = at + static_cast<std::size_t>(i) * text_chunk_bytes;
            next[i] = window_of(text, from, std::min(from + text_chunk_bytes, text.size()), kind);
        });
        for (const Window& window : next) {
            windows.push_back(window);
            if (window.ends_list)
                return windows;
        }
        at = std::min(at + next.size() * text_chunk_bytes, text.size());
        ahead = 4 * std::size_t{executor.workers()};
    }
    return {};
}

/// Divides the windows into runs of whole elements, `most` of them in all.
std::vector<ElementRun> runs_of(const std::vector<Window>& windows, std::size_t most) {
    std::vector<ElementRun> runs;
    std::size_t first = 0;
    for (const Window& window : windows) {
        if (!runs.empty())
            runs.back().end = window.count == 0 ? window.end : window.begin;
        if (window.count > most - first)
            break;
        if (window.count != 0)
            runs.push_back({window.begin, window.end, window.count, first});
        first += window.count;
    }
    return runs;
}

} // namespace

template <class Item>
void read_list(XmlCursor& cursor, const MeshTextKind<Item>& kind, std::size_t vertices,
               std::vector<Item>& items, const std::function<void(std::size_t count)>& make_room,
               Executor& executor) {
    const std::vector<Window> windows = windows_of(cursor.text(), cursor.position(), kind, executor);
    const std::size_t before = items.size();
    std::vector<ElementRun> runs = runs_of(windows, std::numeric_limits<std::uint32_t>::max() - before);
    if (runs.empty() || runs.front().begin != cursor.position())
        return;
    const std::size_t count = runs.back().first + runs.back().count;
    make_room(count);
    if (before == 0)
        resize_in_huge_pages(executor, items, count);
    else
        items.resize(before + count);
    executor.for_chunks(runs.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        ElementRun& run = runs[i];
        XmlCursor elements(cursor.text(), run.begin, run.end, cursor.prefixes());
        run.read = kind.read(elements, vertices, std::span(items).subspan(before + run.first, run.count));
        elements.next();
        run.stop = elements.position();
    });
    for (const ElementRun& run : runs) {
        if (run.stop != run.end) {
            items.resize(before + run.first + run.read);
            return cursor.move_to(run.stop);
        }
        assert(run.read == run.count);
    }
    const bool whole = windows.back().ends_list && runs.back().end == windows.back().end;
    std::uint64_t lines = 0;
    for (const Window& window : windows)
        lines += window.lines;
    cursor.move_to(runs.back().end, whole ? std::optional(lines) : std::nullopt);
}

template void read_list(XmlCursor&, const MeshTextKind<Point3>&, std::size_t, std::vector<Point3>&,
                        const std::function<void(std::size_t)>&, Executor&);
template void read_list(XmlCursor&, const MeshTextKind<TriangleIndices>&, std::size_t,
                        std::vector<TriangleIndices>&, const std::function<void(std::size_t)>&, Executor&);

std::size_t degenerate_triangles(const IndexedMesh& mesh) {
    return static_cast<std::size_t>(
        std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                      [](const TriangleIndices& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

} // namespace lamella
