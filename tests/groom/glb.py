# A mesh with morph targets in binary glTF, from the Khronos Group's specification of glTF 2.0. Each moment is dumped as
# one strand of all vertices.
import array
import json
import struct

import dump


def read(data):
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    scene = json.loads(data[20:20 + size])
    size_of_bytes, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0" and 28 + size + size_of_bytes == len(data)
    body = data[28 + size:]
    assert scene["buffers"] == [{"byteLength": len(body)}]

    def numbers(accessor):
        about = scene["accessors"][accessor]
        view = scene["bufferViews"][about["bufferView"]]
        code = {5126: "f", 5125: "I"}[about["componentType"]]
        assert view["byteLength"] == 4 * about["count"] * {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[about["type"]]
        values = array.array(code, body[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        if "min" in about:
            width = len(about["min"])
            assert [round(min(values[k::width]), 6) for k in range(width)] == [round(v, 6) for v in about["min"]]
        return values

    mesh, = scene["meshes"]
    primitive, = mesh["primitives"]
    base = numbers(primitive["attributes"]["POSITION"])
    triangles = numbers(primitive["indices"])
    assert len(triangles) % 3 == 0 and max(triangles) < len(base) // 3
    normals = numbers(primitive["attributes"]["NORMAL"])
    turned = [normals] + [array.array("f", (a + b for a, b in zip(normals, numbers(target["NORMAL"]))))
                          for target in primitive.get("targets", [])]
    for moment in turned:
        assert len(moment) == len(base)
        assert all(abs(sum(c * c for c in moment[v:v + 3]) - 1) < 1e-4 for v in range(0, len(moment), 3))
    if "TEXCOORD_0" in primitive["attributes"]:
        coordinates = numbers(primitive["attributes"]["TEXCOORD_0"])
        assert 3 * len(coordinates) == 2 * len(base) and min(coordinates) == 0 and max(coordinates) == 1
    targets = [numbers(target["POSITION"]) for target in primitive.get("targets", [])]
    moments = [base] + [array.array("f", (a + b for a, b in zip(base, target))) for target in targets]
    times = [0.0]
    if targets:
        animation, = scene["animations"]
        sampler, = animation["samplers"]
        times = list(numbers(sampler["input"]))
        weights = numbers(sampler["output"])
        count = len(targets)
        for n in range(len(times)):
            row = weights[n * count:(n + 1) * count]
            assert list(row) == [1.0 if k + 1 == n else 0.0 for k in range(count)]
    assert len(times) == len(moments)
    dumped = []
    for points in moments:
        groom = dump.empty()
        dump.counted(groom, [len(points) // 3])
        groom["points"] = points
        dumped.append(groom)
    return times, dumped
