#pragma once

// The functions by which sources add to the extension. Their order in module.cpp matters: a class comes
// before those that use it.

#include "shared_layer.hpp"

#include <pybind11/pybind11.h>

namespace lamella::python {

/// Registers the conversion of C++ exceptions that leave this module to exceptions of the package: a
/// lamella::Error to the class of lamella._errors for its kind, with the same text; std::bad_alloc to a
/// LimitError; anything else to an InternalError.
void register_errors();

/// Binds the class Mesh, and functions that read and make meshes.
void bind_meshes(pybind11::module_& module);
/// Binds the class Plate, and functions that make plates.
void bind_plates(pybind11::module_& module);
/// Binds the class Layer.
void bind_layers(pybind11::module_& module);
/// Binds what is computed of a layer, or made of one: polygons, defects, images, other layers.
void bind_operations(pybind11::class_<SharedLayer, LayerPointer>& cls);
/// Binds the class Stack.
void bind_stacks(pybind11::module_& module);
/// Binds the pixels of all layers of a stack.
void bind_pixels(pybind11::class_<Stack, StackPointer>& cls);
/// Binds functions that make arrays of voxels of a plate.
void bind_voxels(pybind11::module_& module);
/// Binds plans, slicing into a stack, the class LayerStream, and the engines.
void bind_slicing(pybind11::module_& module);
/// Binds the class PreparedMesh, which cuts single planes.
void bind_sections(pybind11::module_& module);
/// Binds the classes of scan strategies.
void bind_strategies(pybind11::module_& module);
/// Binds scanning, and the classes of what it makes.
void bind_scanning(pybind11::module_& module);
/// Binds functions and classes that read, write, check and compare layers.
void bind_files(pybind11::module_& module);

} // namespace lamella::python
