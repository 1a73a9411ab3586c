// THE LIST of passes, in the order in which they are drawn: those into the radiance, then those onto the screen. See
// pass.h for what a pass is.
#pragma once

#include "render/pass_entry.h"

namespace render {

inline constexpr PassMaker kPasses[]{
    makePass<class PlanPass>,        //
    makePass<class HairShadowPass>,  //
    makePass<class BodyShadowPass>,  //
    makePass<class BackdropPass>,    //
    makePass<class StrandPass>,      //
    makePass<class BodyPass>,        //
    makePass<class DebugPass>,       //
    makePass<class ToneMapPass>,     //
};

}  // namespace render
