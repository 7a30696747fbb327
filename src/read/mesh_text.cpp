#include "read/mesh_text.hpp"

#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"
#include "read/read_limits.hpp"
#include "read/text_chunks.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace lamella {

namespace {

/// A chunk of elements that one thread reads.
struct ElementRun {
    std::string_view text;
    std::size_t mesh;
    std::size_t count = 0; ///< elements
    std::size_t first = 0; ///< index of the first in its mesh
    bool plain = true;
};

/// The elements of one kind in all meshes.
template <class Item>
class Elements {
  public:
    Elements(const MeshTextKind<Item>& kind, std::vector<std::string_view> MeshText::*runs,
             std::span<const MeshText> texts)
        : kind_(kind), texts_(texts) {
        for (std::size_t i = 0; i < texts.size(); ++i)
            for (const std::string_view run : texts[i].*runs)
                cut(run, i);
    }

    /// Counts the elements of each chunk if all are plain, and numbers those of each mesh.
    void count(Executor& executor) {
        executor.for_chunks(chunks_.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            ElementRun& chunk = chunks_[i];
            const auto marks =
                static_cast<std::size_t>(std::count(chunk.text.begin(), chunk.text.end(), '<'));
            chunk.count = marks / kind_.marks;
            chunk.plain = marks % kind_.marks == 0 && chunk.count <= chunk.text.size() / kind_.least;
        });
        counts_.assign(texts_.size(), 0);
        for (ElementRun& chunk : chunks_) {
            std::optional<std::size_t>& count = counts_[chunk.mesh];
            if (!chunk.plain)
                count.reset();
            if (!count)
                continue;
            chunk.first = *count;
            *count += chunk.count;
        }
    }

    /// Returns the number of elements, or nullopt if a chunk is not plain.
    [[nodiscard]] const std::optional<std::size_t>& count_of(std::size_t mesh) const { return counts_[mesh]; }

    /// Reads into `items_of(mesh)` and calls `done` with each chunk that was read.
    template <class ItemsOf, class Done>
    void read(Executor& executor, const std::vector<bool>& wanted, const ItemsOf& items_of,
              const Done& done) {
        executor.for_chunks(chunks_.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            ElementRun& chunk = chunks_[i];
            if (!wanted[chunk.mesh])
                return;
            assert(chunk.first + chunk.count <= items_of(chunk.mesh).size());
            const std::span<Item> items = items_of(chunk.mesh).subspan(chunk.first, chunk.count);
            chunk.plain = kind_.read(chunk.text, texts_[chunk.mesh], items) && done(chunk.mesh, items);
        });
    }

    void drop_odd(std::vector<bool>& wanted) const {
        for (const ElementRun& chunk : chunks_)
            if (!chunk.plain)
                wanted[chunk.mesh] = false;
    }

  private:
    /// Divides a sequence into chunks of whole elements.
    void cut(std::string_view run, std::size_t mesh) {
        while (run.size() > text_chunk_bytes) {
            const std::size_t cut = run.find(kind_.tag, text_chunk_bytes);
            if (cut == std::string_view::npos)
                break;
            chunks_.push_back({run.substr(0, cut), mesh});
            run.remove_prefix(cut);
        }
        chunks_.push_back({run, mesh});
    }

    const MeshTextKind<Item>& kind_;
    std::span<const MeshText> texts_;
    std::vector<ElementRun> chunks_;
    std::vector<std::optional<std::size_t>> counts_;
};

std::uint64_t mesh_bytes(std::uint64_t vertices, std::uint64_t triangles) {
    return vertices * sizeof(Point3) + triangles * sizeof(TriangleIndices);
}

} // namespace

void give_back(const IndexedMesh& mesh, ReadLimits& limits) {
    limits.give_back(mesh.triangles.size(), mesh_bytes(mesh.vertices.size(), mesh.triangles.size()));
}

void take_run(XmlCursor& cursor, std::string_view end_tag, std::vector<std::string_view>& runs,
              Executor& executor) {
    const std::string_view document = cursor.text();
    const std::size_t location = cursor.position();
    struct Chunk {
        std::size_t end = std::string_view::npos; ///< where the tag is
        std::uint64_t lines = 0;                  ///< line ends up to there
    };
    // Most sequences are short. Of a long one, all threads search several chunks before the next ones.
    std::size_t chunks_ahead = 1;
    std::uint64_t lines = 0;
    for (std::size_t at = location; at < document.size();) {
        std::vector<Chunk> chunks(std::min((document.size() - at) / text_chunk_bytes + 1, chunks_ahead));
        executor.for_chunks(chunks.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            const std::size_t begin = at + static_cast<std::size_t>(i) * text_chunk_bytes;
            const std::size_t end = std::min(begin + text_chunk_bytes, document.size());
            Chunk& chunk = chunks[i];
            chunk.end = document.substr(0, end - 1 + end_tag.size()).find(end_tag, begin);
            chunk.lines = line_at(document.substr(begin), std::min(chunk.end, end) - begin) - 1;
        });
        for (const Chunk& chunk : chunks) {
            lines += chunk.lines;
            if (chunk.end == std::string_view::npos)
                continue;
            runs.push_back(document.substr(location, chunk.end - location));
            return cursor.move_to(chunk.end, lines);
        }
        at = std::min(at + chunks.size() * text_chunk_bytes, document.size());
        chunks_ahead = 4 * std::size_t{executor.workers()};
    }
}

std::size_t degenerate_triangles(const IndexedMesh& mesh) {
    return static_cast<std::size_t>(
        std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                      [](const TriangleIndices& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

std::vector<std::optional<IndexedMesh>> read_mesh_texts(std::span<const MeshText> texts,
                                                        const MeshTextForm& form, ReadLimits& limits,
                                                        Executor& executor) {
    Elements<Point3> vertices(form.vertex, &MeshText::vertices, texts);
    Elements<TriangleIndices> triangles(form.triangle, &MeshText::triangles, texts);
    vertices.count(executor);
    triangles.count(executor);

    std::vector<bool> plain(texts.size());
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t i = 0; i < texts.size(); ++i) {
        plain[i] = vertices.count_of(i) && triangles.count_of(i) && *vertices.count_of(i) <= most &&
                   *triangles.count_of(i) <= most;
        if (!plain[i])
            continue;
        limits.add_triangles(*triangles.count_of(i), texts[i].location);
        limits.add_bytes(mesh_bytes(*vertices.count_of(i), *triangles.count_of(i)), texts[i].location);
    }

    std::vector<std::optional<IndexedMesh>> meshes(texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (!plain[i])
            continue;
        IndexedMesh& mesh = meshes[i].emplace();
        resize_in_huge_pages(executor, mesh.vertices, *vertices.count_of(i));
        resize_in_huge_pages(executor, mesh.triangles, *triangles.count_of(i));
    }
    vertices.read(
        executor, plain, [&](std::size_t i) { return std::span(meshes[i]->vertices); },
        [](std::size_t, std::span<const Point3>) { return true; });
    triangles.read(
        executor, plain, [&](std::size_t i) { return std::span(meshes[i]->triangles); },
        [&](std::size_t i, std::span<const TriangleIndices> items) {
            std::uint32_t largest = 0;
            for (const TriangleIndices& corners : items)
                largest = std::max({largest, corners[0], corners[1], corners[2]});
            return items.empty() || largest < meshes[i]->vertices.size();
        });
    vertices.drop_odd(plain);
    triangles.drop_odd(plain);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (!plain[i] && meshes[i]) {
            give_back(*meshes[i], limits);
            meshes[i].reset();
        }
        assert(plain[i] == meshes[i].has_value());
    }
    return meshes;
}

} // namespace lamella
