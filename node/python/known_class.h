// palpate._core: curves of a known class, placed and fitted, without a recognizer.
#pragma once

#include <pybind11/pybind11.h>

namespace palpate {

void add_known_class(pybind11::module_& module);

}  // namespace palpate
