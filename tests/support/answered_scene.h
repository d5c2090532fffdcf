// A scene with the recognizer's weighing, as the recognition tree gets it.
#pragma once

#include <vector>

#include "core/recognition/patch_contacts.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/weigh/weigh.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/unbounded_work.h"

namespace palpate::test {

/// The inputs of reported_tree_path().
struct AnsweredScene {
  Weighing weighing;
  std::vector<LocalizedContact> contacts;
};

/// With the scene's noise stated; weighed twice, the second time starting from the first weighing.
inline AnsweredScene answered(const Scene& scene) {
  const std::vector<StoredPatch> patches = stored_patches(scene, scene.sigma_m);
  const FitData data = make_fit_data(patches, 0.0);
  const std::vector<SidedStart> starts = weigh(data, patches, test::unbounded_work()).starts;
  AnsweredScene answered{weigh(data, patches, test::unbounded_work(), {}, starts), {}};
  answered.contacts = PatchContacts().of(patches, answered.weighing.sides, {}, {});
  return answered;
}

}  // namespace palpate::test
