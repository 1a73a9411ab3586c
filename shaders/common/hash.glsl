// Integer hashing, the same on every implementation because only 32-bit integer arithmetic is used.
// Source: PCG output permutation, M. O'Neill 2014; as a hash: Jarzynski and Olano 2020.
uint hash(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

uint hash(uint x, uint y) { return hash(x ^ hash(y)); }

// [0, 1): 24 bits, exact in a float.
float unitFloat(uint x) { return float(x >> 8u) * (1.0 / 16777216.0); }

// The n-th independent number of a key, in [0, 1).
float randomOf(uint key, uint n) { return unitFloat(hash(key + n * 0x9e3779b9u)); }
