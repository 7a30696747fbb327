#include "shared_layer.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

namespace lamella::python {

const LayerMeasure& SharedLayer::measure() const {
    std::call_once(measured_, [&] { measure_ = lamella::measure(layer_); });
    return measure_;
}

const Nesting& SharedLayer::nesting() const {
    std::call_once(nested_, [&] {
        nesting_ = lamella::nesting(layer_);
        parents_.assign(layer_.contours(), -1);
        for (std::size_t i = 0; i < nesting_.rings(); ++i)
            if (nesting_.parent[i] != Nesting::none)
                parents_[i] = nesting_.parent[i];
    });
    return nesting_;
}

const std::vector<std::int64_t>& SharedLayer::parents() const {
    static_cast<void>(nesting());
    return parents_;
}

std::uint64_t SharedLayer::hash() const {
    std::call_once(hashed_, [&] { hash_ = content_hash(layer_); });
    return hash_;
}

Box3 box_of(const std::vector<LayerPointer>& layers) {
    Box3 box;
    for (const LayerPointer& layer : layers)
        for (const PointArray* points : {&layer->get().points, &layer->get().hatches})
            for (const Point2& p : *points)
                box.add(Point3{p.x, p.y, layer->get().z});
    if (!box.empty()) {
        box.min.z = layers.front()->get().bottom;
        box.max.z = layers.back()->get().top;
    }
    return box;
}

Box3 shown_box(const Stack& stack) {
    if (!stack.box.empty() || stack.layers.empty())
        return stack.box;
    return {{0, 0, stack.layers.front()->get().bottom}, {0, 0, stack.layers.back()->get().top}};
}

std::vector<LayerPointer> shared(LayerStack layers) {
    std::vector<LayerPointer> pointers;
    pointers.reserve(layers.size());
    for (Layer& layer : layers)
        pointers.push_back(std::make_shared<SharedLayer>(std::move(layer)));
    return pointers;
}

PlaneRule rule_named(const std::string& name) {
    const std::optional<PlaneRule> rule = plane_rule(name);
    if (!rule)
        throw Error(ErrorKind::usage,
                    "rule: \"" + name + "\" is neither \"section_above\" nor \"section_below\"");
    return *rule;
}

LayerStack plain(const Stack& stack) {
    LayerStack layers;
    layers.reserve(stack.layers.size());
    for (const LayerPointer& layer : stack.layers)
        layers.push_back(layer->get());
    return layers;
}

} // namespace lamella::python
