// Small pictures for the page.
#pragma once

#include "pictures.hpp"

namespace postfx::host::study {

/// What the effect was given, the truth, and per level where a viewer sees that it is not the truth: FLIP in heat
/// colours, white being EffectFindings::heat_white. Without a truth, the levels' pictures.
void add_thumbnails(EffectFindings& findings, const View& view, const std::vector<LevelPicture>& pictures,
                    const Image64* truth);

} // namespace postfx::host::study
