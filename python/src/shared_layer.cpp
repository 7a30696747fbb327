#include "shared_layer.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "gil_release.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

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
    std::call_once(hashed_, [&] { hash_ = hatches_.empty() ? content_hash(layer_) : content_hash(plane()); });
    return hash_;
}

std::string hash_text(const SharedLayer& layer) {
    std::uint64_t hash = 0;
    {
        const GilRelease released;
        hash = layer.hash();
    }
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
    return text.data();
}

bool same(const SharedLayer& first, const SharedLayer& second) {
    const Layer& a = first.get();
    const Layer& b = second.get();
    return a.index == b.index && a.z == b.z && a.bottom == b.bottom && a.top == b.top &&
           same_contours(a, b) && std::ranges::equal(first.hatches(), second.hatches());
}

Box3 box_of(const std::vector<LayerPointer>& layers) {
    std::vector<PointArray> hatches;
    for (const LayerPointer& layer : layers)
        hatches.push_back(layer->hatches());
    return part_box(plain(layers), hatches);
}

Box3 shown_box(const Stack& stack) {
    if (!stack.box.empty())
        return stack.box;
    if (stack.layers.empty())
        return {{0, 0, 0}, {0, 0, 0}};
    return {{0, 0, stack.layers.front()->get().bottom}, {0, 0, stack.layers.back()->get().top}};
}

std::vector<LayerPointer> shared(LayerStack layers, std::optional<PlaneRule> rule,
                                 std::vector<PointArray> hatches,
                                 const std::vector<std::shared_ptr<Stack>>& parts) {
    hatches.resize(layers.size());
    std::vector<LayerPointer> pointers;
    pointers.reserve(layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        std::vector<LayerPointer> of_parts;
        for (const std::shared_ptr<Stack>& part : parts)
            of_parts.push_back(part->layers[i]);
        pointers.push_back(std::make_shared<SharedLayer>(std::move(layers[i]), rule, std::move(hatches[i]),
                                                         std::move(of_parts)));
    }
    return pointers;
}

Layer with_own_points(Layer layer) {
    layer.points = PointArray(std::vector(layer.points.begin(), layer.points.end()));
    return layer;
}

PlaneRule rule_named(const std::string& name) {
    const std::optional<PlaneRule> rule = plane_rule(name);
    if (!rule)
        throw Error(ErrorKind::usage,
                    "rule: \"" + name + "\" is neither \"section_above\" nor \"section_below\"");
    return *rule;
}

FillRule fill_rule(const std::string& name) {
    for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd, FillRule::positive})
        if (fill_rule_name(rule) == name)
            return rule;
    return FillRule::none;
}

BottomInset bottom_inset(const InsetAndHeight& given, double plate_mm) {
    return given ? BottomInset{.inset_mm = given->first, .height_mm = given->second, .plate_mm = plate_mm}
                 : BottomInset();
}

LayerStack plain(const std::vector<LayerPointer>& shared) {
    LayerStack layers;
    layers.reserve(shared.size());
    for (const LayerPointer& layer : shared)
        layers.push_back(layer->get());
    return layers;
}

std::vector<LayerStack> plain_parts(const Stack& stack) {
    if (stack.parts.empty())
        return {plain(stack.layers)};
    std::vector<LayerStack> parts;
    for (const std::shared_ptr<Stack>& part : stack.parts)
        parts.push_back(plain(part->layers));
    return parts;
}

} // namespace lamella::python
