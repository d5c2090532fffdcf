// palpate._core: what palpate fit says of a file's samples, said of arrays.
#pragma once

#include <pybind11/pybind11.h>

namespace palpate {

void add_array_check(pybind11::module_& module);

}  // namespace palpate
