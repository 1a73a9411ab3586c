// How a strand leaves its guide: wander, drift, curls, waves, frizz, and what lifts stray hairs off the head. A part of
// strand.glsl, which includes it where what it needs is known.

// From 0 at the root to 1 well beyond `reach` (m); way and result: a value and its rate by s.
vec2 opening(vec2 way, float reach) {
  float square = way.x * way.x, far = reach * reach, sum = square + far;
  return vec2(square / sum, 2.0 * way.x * far / (sum * sum) * way.y);
}

// Adds away open sin(angle) to an offset (xy, m) and its rate by s (zw); open and angle: a value and its rate by s.
void addSwing(inout vec4 bend, vec2 away, vec2 open, vec2 angle) {
  float sine = sin(angle.x);
  bend.xy += open.x * sine * away;
  bend.zw += (open.y * sine + open.x * cos(angle.x) * angle.y) * away;
}

// The angle of a swing of some wave length (m) and phase (in turns), with its rate by s.
vec2 swingAngle(vec2 way, float wave_length, float phase) {
  float rate = 2.0 * kPi / wave_length;
  return vec2(rate * way.x + 2.0 * kPi * phase, rate * way.y);
}

// A hair's own way beside its guide, over all of its length; stray and fine hairs go further astray.
void addWander(in Strand strand, float s, inout vec4 bend) {
  float span = strand.loose + strand.fine > 0.0 ? max(strand.end, 1e-3) : float(strand.layers - 1), t = s / span;
  float reach = shape.y * (1.0 + 5.0 * strand.loose + 3.0 * strand.rim) + 0.06 * strand.fine * strand.metres;
  vec2 away = reach * sqrt(randomOf(strand.key, 9u)) * onCircle(randomOf(strand.key, 8u));
  vec2 grow = vec2(t * (1.6 - 0.6 * t), (1.6 - 1.2 * t) / span);
  float turns = 0.7 + 0.8 * randomOf(strand.key, 10u);
  bend += 0.6 * vec4(grow.x * away, grow.y * away);
  addSwing(bend, 0.4 * away, grow, 2.0 * kPi * vec2(turns * t + randomOf(strand.key, 11u), turns / span));
}

// Locks and clumps go ways of their own.
void addDrift(in Strand strand, vec2 way, inout vec4 bend) {
  float reach = groups.z * strand.hold;
  addSwing(bend, 1.5 * reach * onCircle(randomOf(strand.lock_key, 10u)), opening(way, 0.08),
           swingAngle(way, 0.12 + 0.13 * randomOf(strand.lock_key, 11u), randomOf(strand.lock_key, 12u)));
  addSwing(bend, reach * onCircle(randomOf(strand.clump_key, 10u)), opening(way, 0.05),
           swingAngle(way, 0.06 + 0.07 * randomOf(strand.clump_key, 11u), randomOf(strand.clump_key, 12u)));
}

// A helix. Pitch, hand and phase are the clump's, a little of the phase and of the radius the strand's.
void addCurl(in Strand strand, float s, vec2 way, inout vec4 bend) {
  float pitch = max(shape.w, 1e-3) * (0.8 + 0.4 * randomOf(strand.clump_key, 8u));
  float hand = randomOf(strand.clump_key, 13u) < 0.5 ? -1.0 : 1.0;
  vec2 angle = swingAngle(way, pitch, randomOf(strand.clump_key, 9u) + 0.15 * (randomOf(strand.key, 12u) - 0.5));
  vec2 radius = shape.z * (0.7 + 0.4 * randomOf(strand.clump_key, 14u) + 0.3 * randomOf(strand.key, 13u)) *
                opening(way, 0.025);
  if (shares.x > 0) {
    vec4 rate, share = shareAlong(s / max(strand.end, 1e-3), 0, rate);
    radius = strand.share.of.z * vec2(radius.x * share.z, radius.y * share.z + radius.x * rate.z / max(strand.end, 1e-3));
  }
  float c = cos(angle.x), d = hand * sin(angle.x);
  bend += vec4(radius.x * c, radius.x * d, radius.y * c - radius.x * d * hand * angle.y,
               radius.y * d + radius.x * c * hand * angle.y);
}

// A wave in one plane, the lock's.
void addWave(in Strand strand, vec2 way, inout vec4 bend) {
  float wave_length = max(waves.y, 1e-3) * (0.85 + 0.3 * randomOf(strand.lock_key, 14u));
  float phase = 0.6 * randomOf(strand.lock_key, 15u) + 0.12 * (randomOf(strand.key, 26u) - 0.5);
  addSwing(bend, 0.5 * waves.x * (0.8 + 0.4 * randomOf(strand.key, 27u)) * onCircle(randomOf(strand.lock_key, 16u)),
           opening(way, 0.035), swingAngle(way, wave_length, phase));
}

// Noise of each hair's own: most have little of it, some much.
void addFrizz(in Strand strand, vec2 way, inout vec4 bend) {
  float own = randomOf(strand.key, 28u), reach = clumping.z * strand.share.frizz * (0.3 + 1.7 * own * own);
  vec2 open = opening(way, 0.03);
  addSwing(bend, vec2(reach, 0.0), open,
           swingAngle(way, 0.025 + 0.05 * randomOf(strand.key, 14u), randomOf(strand.key, 16u)));
  addSwing(bend, vec2(0.0, reach), open,
           swingAngle(way, 0.025 + 0.05 * randomOf(strand.key, 15u), randomOf(strand.key, 17u)));
}

// What a strand leaves its guide by at parameter s: xy the offset (m) in the strand's frame, zw its rate by s.
vec4 sideways(in Strand strand, float s) {
  vec2 way = wayAt(strand, s);
  vec4 bend = vec4(0.0);
  addWander(strand, s, bend);
  if (groups.z > 0.0) addDrift(strand, way, bend);
  if (shape.z > 0.0) addCurl(strand, s, way, bend);
  if (waves.x > 0.0) addWave(strand, way, bend);
  if (clumping.z > 0.0) addFrizz(strand, way, bend);
  return bend;
}

// m that a stray or fine hair stands off the hair, away from the head, and its rate by s.
vec2 lifted(in Strand strand, float s) {
  float chance = randomOf(strand.key, 29u);
  float lift = strand.loose * groups.w * (0.2 + 1.8 * chance * chance) + 0.35 * strand.fine * chance * strand.metres;
  return lift * opening(wayAt(strand, s), 0.3 * min(strand.metres, 0.15) + 1e-4);
}

// m that sideways() and lifted() take a strand from its guide by at most.
float mostBent(in Strand strand) {
  return shape.y * (1.0 + 5.0 * strand.loose + 3.0 * strand.rim) + 2.5 * groups.z + variation.z +
         2.0 * strand.loose * groups.w + 0.41 * strand.fine * strand.metres;
}
