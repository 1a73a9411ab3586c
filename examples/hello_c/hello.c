/* Hello, hair, in C99: reads a hair mesh from an OBJ file, turns the head under it to and fro, and prints where the tip of
 * one column goes. hello_c HAIR.obj [SECONDS] */
#include <hairmesh.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double kPi = 3.14159265358979323846;

static int failed(void) {
  fprintf(stderr, "%s\n", hm_error_message());
  return 1;
}

static char* readText(const char* file, size_t* length) {
  FILE* stream = fopen(file, "rb");
  char* text = malloc(1 << 24);
  *length = stream && text ? fread(text, 1, 1 << 24, stream) : 0;
  if (stream) fclose(stream);
  return text;
}

/* The head turns 60 degrees to either side, twice a second. A skull around its joint moves with it. */
static void pose(double time, hm_step_input* step, hm_ellipsoid* skull) {
  const double swing = kPi / 3, rate = 2 * kPi * 2, angle = swing * sin(rate * time);
  const double speed = swing * rate * cos(rate * time);
  const double x = 0.005 * sin(angle), y = 0.085, z = 0.005 * cos(angle);
  hm_default_step_input(step);
  step->time = time;
  step->head.rotation[1] = sin(angle / 2);
  step->head.rotation[3] = cos(angle / 2);
  hm_default_ellipsoid(skull);
  skull->pose = step->head;
  skull->pose.position[0] = x, skull->pose.position[1] = y, skull->pose.position[2] = z;
  skull->radii[0] = 0.072, skull->radii[1] = 0.1, skull->radii[2] = 0.09;
  skull->velocity[0] = speed * z, skull->velocity[2] = -speed * x;
  skull->angular_velocity[1] = speed;
  step->ellipsoids = skull;
  step->ellipsoid_count = 1;
}

/* FNV-1a of the positions' bytes. */
static unsigned long long hash(const hm_view* view) {
  const unsigned char* bytes = (const unsigned char*)view->data;
  unsigned long long value = 14695981039346656037ull;
  for (size_t i = 0; i < view->count * view->stride; ++i) value = (value ^ bytes[i]) * 1099511628211ull;
  return value;
}

int main(int count, char** arguments) {
  if (count < 2) {
    fprintf(stderr, "hello_c HAIR.obj [SECONDS]\n");
    return 2;
  }
  size_t length = 0;
  char* text = readText(arguments[1], &length);
  if (!length) {
    fprintf(stderr, "%s: cannot be read, or is empty; give a hair mesh (OBJ)\n", arguments[1]);
    free(text);
    return 1;
  }
  const double seconds = count > 2 ? atof(arguments[2]) : 2;
  hm_mesh mesh;
  hm_hair hair;
  hm_mesh_info info;
  hm_view positions;
  const hm_result read = hm_mesh_create_from_text(text, length, arguments[1], 0, &mesh);
  free(text);
  if (read != HM_OK) return failed();
  if (hm_hair_create(mesh, NULL, &hair) != HM_OK || hm_mesh_describe(mesh, &info) != HM_OK) return failed();
  if (hm_hair_positions(hair, &positions) != HM_OK) return failed();
  const double* tip = positions.data + 3 * (info.column_first[1] - 1);

  printf("%d columns, %d vertices\n  time s     x m     y m     z m\n", info.column_count, info.vertex_count);
  for (int n = 1; n / 60.0 <= seconds; ++n) {
    hm_step_input step;
    hm_ellipsoid skull;
    pose(n / 60.0, &step, &skull);
    if (hm_hair_step(hair, &step, NULL) != HM_OK) return failed();
    printf("%8.3f %7.4f %7.4f %7.4f\n", step.time, tip[0], tip[1], tip[2]);
  }
  printf("end state: %016llx\n", hash(&positions));
  hm_hair_destroy(hair);
  hm_mesh_destroy(mesh);
  return 0;
}
