#include "input.hpp"

namespace py = pybind11;

namespace lamella::python {

Input::Input(const py::object& source) {
    if (!py::isinstance<py::tuple>(source)) {
        name_ = source.cast<std::string>();
        return;
    }
    const auto pair = source.cast<py::tuple>();
    name_ = pair[0].cast<std::string>();
    Py_buffer content;
    if (PyObject_GetBuffer(py::object(pair[1]).ptr(), &content, PyBUF_SIMPLE) != 0)
        throw py::error_already_set();
    content_ = std::shared_ptr<Py_buffer>(new Py_buffer(content), [](Py_buffer* buffer) {
        PyBuffer_Release(buffer);
        delete buffer;
    });
}

void Input::label(MeshFile& file) const {
    if (!content_)
        return;
    for (MeshInstance& instance : file.instances)
        if (instance.name.empty() &&
            (file.instances.size() == 1 || file.objects[instance.object].name.empty()))
            instance.name = "part";
}

} // namespace lamella::python
