#pragma once

// Detects objects that are not constructed, because a derived class uses itself before it calls __init__ of
// its base, or because only __new__ was called. pybind11 would pass uninitialised memory to functions.

#include "lamella/contour/exposure.hpp"
#include "lamella/scan/strategy.hpp"

#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

namespace lamella::python {

class SharedLayer;
struct Stack;
class SourceMesh;
class LayerStream;

template <class T, class... Classes>
inline constexpr bool is_one_of = (std::is_same_v<T, Classes> || ...);

template <class T>
inline constexpr bool is_class_of_users =
    is_one_of<T, SharedLayer, Stack, SourceMesh, LayerStream, ParameterSet, HatchRule, ContourRule, SkinRule,
              SupportRule, ScanStrategy, Exposure, ScanFigures>;

} // namespace lamella::python

template <class T>
class pybind11::detail::type_caster<T, std::enable_if_t<lamella::python::is_class_of_users<T>>>
    : public type_caster_base<T> {
  public:
    bool load(handle source, bool convert) {
        if (isinstance<T>(source) && !reinterpret_cast<instance*>(source.ptr())
                                          ->get_value_and_holder(get_type_info(typeid(T)))
                                          .value_ptr())
            throw type_error(std::string(Py_TYPE(source.ptr())->tp_name) +
                             ": the __init__ of its base class has not been called");
        return type_caster_base<T>::load(source, convert);
    }
};
