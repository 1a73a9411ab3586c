// THE LIST of passes, in the order in which they are drawn. See pass.h for what a pass is.
#pragma once

#include "render/backdrop_pass.h"
#include "render/body_pass.h"
#include "render/debug_pass.h"
#include "render/pass.h"
#include "render/plan_pass.h"
#include "render/shadow_pass.h"
#include "render/strand_pass.h"
#include "render/tone_map_pass.h"

namespace render {

// Into the radiance. Its picture is kept while nothing changes that one of them depends on.
using RadiancePasses = PassList<  //
    PlanPass,                     //
    HairShadowPass,               //
    BodyShadowPass,               //
    BackdropPass,                 //
    BodyPass,                     //
    StrandPass,                   //
    DebugPass>;

// Onto the screen, in every frame.
using ScreenPasses = PassList<  //
    ToneMapPass>;

}  // namespace render
