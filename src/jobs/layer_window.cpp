#include "jobs/layer_window.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace lamella {

PlaneRange widened(PlaneRange planes, std::uint32_t below, std::uint32_t above, PlaneRange all) noexcept {
    return {planes.begin - std::min(below, planes.begin - all.begin),
            planes.end + std::min(above, all.end - planes.end)};
}

LayerWindow::LayerWindow(PlaneRange coming, PlaneRange wanted, std::uint32_t below, std::uint32_t above,
                         Make make, Work work)
    : coming_(coming), wanted_(wanted), below_(below), above_(above), make_(std::move(make)),
      work_(std::move(work)) {
    assert(wanted.size() == 0 || (coming.begin <= wanted.begin && wanted.end <= coming.end));
}

/// Returns the planes that a plane needs, including itself.
PlaneRange LayerWindow::neighbours(std::uint32_t plane) const noexcept {
    return widened({plane, plane + 1}, below_, above_, coming_);
}

/// Returns the planes that need a plane.
PlaneRange LayerWindow::users(std::uint32_t plane) const noexcept {
    const PlaneRange all = widened({plane, plane + 1}, above_, below_, coming_);
    const std::uint32_t begin = std::max(wanted_.begin, all.begin);
    return {begin, std::max(begin, std::min(wanted_.end, all.end))};
}

Commit LayerWindow::prepare(std::uint32_t plane, std::span<const Layer> parts) {
    assert(coming_.begin <= plane && plane < coming_.end);
    std::vector<ScanLayer> layers;
    for (std::size_t part = 0; part < parts.size(); ++part)
        layers.push_back(make_(part, parts[part]));
    if (const Parts beside = held_beside(plane))
        for (std::size_t part = 0; part < layers.size(); ++part)
            layers[part].share_points((*beside)[part]);
    for (const Complete& complete :
         store(plane, std::make_shared<const std::vector<ScanLayer>>(std::move(layers))))
        work_on(complete);
    return [this, plane](Completions& after) {
        finish(plane, after);
    };
}

/// Returns the layers of an adjacent plane that is held; null if there is none.
LayerWindow::Parts LayerWindow::held_beside(std::uint32_t plane) {
    const std::lock_guard lock(mutex_);
    for (const std::uint32_t beside : {plane - 1, plane + 1}) // an index that is not a plane is never held
        if (const auto found = held_.find(beside); found != held_.end())
            return found->second.parts;
    return nullptr;
}

std::vector<LayerWindow::Complete> LayerWindow::store(std::uint32_t plane, Parts parts) {
    const std::lock_guard lock(mutex_);
    const PlaneRange its_users = users(plane);
    if (its_users.size() == 0)
        return {};
    const bool is_new = held_.emplace(plane, Held{std::move(parts), its_users.size()}).second;
    assert(is_new);
    static_cast<void>(is_new);
    std::vector<Complete> complete;
    for (std::uint32_t user = its_users.begin; user < its_users.end; ++user) {
        std::uint32_t& missing = missing_.emplace(user, neighbours(user).size()).first->second;
        if (--missing == 0)
            complete.push_back(take(user));
    }
    return complete;
}

/// Returns a plane with its neighbours, and releases layers that no further plane needs. The mutex must be
/// held.
LayerWindow::Complete LayerWindow::take(std::uint32_t plane) {
    missing_.erase(plane);
    Complete complete{plane, {}};
    const PlaneRange range = neighbours(plane);
    for (std::uint32_t p = range.begin; p < range.end; ++p) {
        const auto found = held_.find(p);
        assert(found != held_.end());
        complete.layers.push_back(found->second.parts);
        if (--found->second.users == 0)
            held_.erase(found);
    }
    return complete;
}

void LayerWindow::work_on(const Complete& complete) {
    const std::uint32_t first = neighbours(complete.plane).begin;
    const std::size_t own = complete.plane - first;
    PlaneLayers plane{.plane = complete.plane, .parts = *complete.layers[own]};
    for (std::size_t i = own; i-- > 0;)
        plane.below.emplace_back(*complete.layers[i]);
    for (std::size_t i = own + 1; i < complete.layers.size(); ++i)
        plane.above.emplace_back(*complete.layers[i]);
    Commit commit = work_(plane);
    const std::lock_guard lock(mutex_);
    ready_.emplace(complete.plane, std::move(commit));
}

// The commit of a plane is called after all planes below are prepared, so the work on complete planes has
// ended.
void LayerWindow::finish(std::uint32_t last, Completions& after) {
    const PlaneRange its_users = users(last);
    for (std::uint32_t plane = its_users.begin; plane < its_users.end; ++plane) {
        if (neighbours(plane).end != last + 1)
            continue;
        Commit commit;
        {
            const std::lock_guard lock(mutex_);
            const auto found = ready_.find(plane);
            assert(found != ready_.end());
            commit = std::move(found->second);
            ready_.erase(found);
        }
        if (commit)
            commit.in_order(after);
    }
}

} // namespace lamella
