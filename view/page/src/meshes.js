// Render meshes: clusters of a pack become one mesh for each material. schema/render.fbs and
// runtime/include/galactic/render_meshes.h tell the layout.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, FrontSide, Group, LinearFilter,
  LinearMipmapLinearFilter, Mesh, MeshBasicMaterial, MeshLambertMaterial, RepeatWrapping, SRGBColorSpace,
} from "three";
import { freeWith } from "./stage.js";

const kClusterBytes = 48;
const kVertexRows = 5;
const kTriangleRows = 3;
const pooledAt = (index, row, rows) => ((index >> 3) * rows + row) * 8 + (index & 7);

function clusterAt(view, number) {
  const at = number * kClusterBytes;
  return {
    origin: [view.getInt32(at, true), view.getInt32(at + 4, true), view.getInt32(at + 8, true)],
    u: view.getFloat32(at + 12, true), v: view.getFloat32(at + 16, true),
    uStep: view.getFloat32(at + 20, true), vStep: view.getFloat32(at + 24, true),
    firstVertex: view.getUint32(at + 28, true), firstTriangle: view.getUint32(at + 32, true),
    vertices: view.getUint16(at + 36, true), triangles: view.getUint16(at + 38, true),
    material: view.getUint16(at + 40, true), twoSided: view.getUint16(at + 44, true) !== 0,
  };
}

/// Linear light of the 256 sRGB values, as shares of 65535.
const kLinear = Uint16Array.from({ length: 256 }, (_, n) => {
  const c = n / 255;
  return Math.round(65535 * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
});

/// Whether vertices of these clusters have colors of their own: light that was baked, or scanned. White
/// is what the others of a pack have.
function haveColors(clusters, { colors }) {
  const isColored = (color) => (color & 0xffffff) !== 0xffffff;
  return clusters.some((one) => colors.subarray(one.firstVertex, one.firstVertex + one.vertices).some(isColored));
}

function geometryOf(clusters, arrays, step) {
  const vertexCount = clusters.reduce((sum, one) => sum + one.vertices, 0);
  const triangleCount = clusters.reduce((sum, one) => sum + one.triangles, 0);
  const positions = new Float32Array(3 * vertexCount);
  const uvs = new Float32Array(2 * vertexCount);
  const colors = haveColors(clusters, arrays) ? new Uint16Array(3 * vertexCount) : null;
  const corners = new Uint32Array(3 * triangleCount);
  let vertex = 0;
  let corner = 0;
  for (const cluster of clusters) {
    const first = vertex;
    for (let n = 0; n < cluster.vertices; ++n, ++vertex) {
      const at = cluster.firstVertex + n;
      for (let row = 0; row < 3; ++row) {
        positions[3 * vertex + row] = step * (cluster.origin[row] + arrays.vertices[pooledAt(at, row, kVertexRows)]);
      }
      uvs[2 * vertex] = cluster.u + cluster.uStep * arrays.vertices[pooledAt(at, 3, kVertexRows)];
      uvs[2 * vertex + 1] = cluster.v + cluster.vStep * arrays.vertices[pooledAt(at, 4, kVertexRows)];
      for (let channel = 0; colors && channel < 3; ++channel) {
        colors[3 * vertex + channel] = kLinear[(arrays.colors[at] >>> (8 * channel)) & 255];
      }
    }
    for (let n = 0; n < cluster.triangles; ++n) {
      for (let c = 0; c < 3; ++c) {
        corners[corner++] = first + arrays.triangles[pooledAt(cluster.firstTriangle + n, c, kTriangleRows)];
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("uv", new BufferAttribute(uvs, 2));
  if (colors) geometry.setAttribute("color", new BufferAttribute(colors, 3, true));
  geometry.setIndex(new BufferAttribute(corners, 1));
  return geometry;
}

/// A level of BC1 blocks as RGBA, as runtime/src/layout/bc1.cpp decodes it.
function decodeBlocks(blocks, size) {
  const out = new Uint8Array(4 * size * size);
  const edge = Math.max(1, size >> 2);
  const palette = new Uint8Array(12);
  for (let block = 0; block < edge * edge; ++block) {
    const at = 8 * block;
    const ends = [blocks[at] | (blocks[at + 1] << 8), blocks[at + 2] | (blocks[at + 3] << 8)];
    ends.forEach((color, n) => {
      const [r, g, b] = [color >> 11, (color >> 5) & 63, color & 31];
      palette.set([(r << 3) | (r >> 2), (g << 2) | (g >> 4), (b << 3) | (b >> 2)], 3 * n);
    });
    for (let c = 0; c < 3; ++c) {
      const [a, b] = [palette[c], palette[3 + c]];
      palette[6 + c] = ends[0] > ends[1] ? (2 * a + b + 1) / 3 : (a + b + 1) >> 1;
      palette[9 + c] = ends[0] > ends[1] ? (a + 2 * b + 1) / 3 : 0;
    }
    for (let texel = 0; texel < 16; ++texel) {
      const x = 4 * (block % edge) + (texel & 3);
      const y = 4 * Math.floor(block / edge) + (texel >> 2);
      if (x >= size || y >= size) continue;
      const code = (blocks[at + 4 + (texel >> 2)] >> (2 * (texel & 3))) & 3;
      const to = 4 * (y * size + x);
      out.set(palette.subarray(3 * code, 3 * code + 3), to);
      out[to + 3] = 255;
    }
  }
  return out;
}

/// Texels of residuals: view/page_assets.cpp writes four planes of what differs from the expected.
function undoResiduals(residuals, size) {
  const count = size * size;
  const planes = residuals.slice();
  for (let channel = 0; channel < 4; ++channel) {
    const plane = planes.subarray(channel * count, (channel + 1) * count);
    for (let n = 0; n < count; ++n) {
      const isFirst = n % size === 0;
      const left = isFirst ? 0 : plane[n - 1];
      const above = n < size ? 0 : plane[n - size];
      const corner = isFirst || n < size ? 0 : plane[n - size - 1];
      const low = Math.min(left, above);
      const high = Math.max(left, above);
      plane[n] += corner >= high ? low : corner <= low ? high : left + above - corner;
    }
  }
  const texels = new Uint8Array(4 * count);
  for (let n = 0; n < count; ++n) {
    const green = planes[count + n];
    texels[4 * n] = planes[n] + green;
    texels[4 * n + 1] = green;
    texels[4 * n + 2] = planes[2 * count + n] + green;
    texels[4 * n + 3] = planes[3 * count + n];
  }
  return texels;
}

export class MeshLibrary {
  // For tests.
  static decodeBlocks = decodeBlocks;

  constructor(data, textures, stage) {
    this.data = data;
    this.textures = textures;
    this.stage = stage;
    this.loaded = new Map();
    this.isShaded = true;
    this.pairs = new Set();
  }

  /// A texture; whoever has no use for it any more calls release().
  texture(number) {
    if (!this.loaded.has(number)) this.loaded.set(number, { users: 0, texture: this.loadTexture(this.textures[number]) });
    const found = this.loaded.get(number);
    ++found.users;
    return found.texture;
  }

  /// Frees a texture that nothing has on any more; it is unpacked again when something needs it.
  release(number) {
    const { users, texture } = this.loaded.get(number);
    this.loaded.get(number).users = users - 1;
    if (users > 1) return;
    this.loaded.delete(number);
    texture.then((one) => one.dispose());
  }

  async loadTexture(stored) {
    const { texels } = await this.data.arrays(stored.data);
    const pixels = stored.format === "bc1" ? decodeBlocks(texels, stored.size) : undoResiduals(texels, stored.size);
    const texture = new DataTexture(pixels, stored.size, stored.size);
    texture.colorSpace = SRGBColorSpace;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    texture.magFilter = LinearFilter;
    texture.minFilter = LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    texture.anisotropy = 4;
    texture.needsUpdate = true;
    return texture;
  }

  /// A mesh that is lit or shown as it is, as the page's switch says. What has its light in the colors of
  /// its vertices needs no other.
  mesh(geometry, options, hasLight) {
    const vertexColors = geometry.hasAttribute("color");
    const plain = new MeshBasicMaterial({ ...options, vertexColors });
    const lit = hasLight ? plain : new MeshLambertMaterial({ ...options, vertexColors, flatShading: true });
    const mesh = new Mesh(geometry, this.isShaded ? lit : plain);
    mesh.userData.materials = { lit, plain };
    return mesh;
  }

  setShaded(isShaded) {
    this.isShaded = isShaded;
    this.stage.content.traverse((one) => {
      if (one.userData.materials) one.material = isShaded ? one.userData.materials.lit : one.userData.materials.plain;
    });
    this.stage.draw();
  }

  /// What a part of a pack looks like; null where it has nothing to show. `cut`: whether the cutting
  /// plane of the stage applies.
  async model(meshes, part, { cut = false } = {}) {
    const model = meshes?.models.find((one) => one.part === part);
    if (!model) return null;
    const arrays = await this.data.arrays(meshes.data);
    const view = new DataView(arrays.clusters.buffer, arrays.clusters.byteOffset, arrays.clusters.byteLength);
    const byKind = new Map();
    for (let n = 0; n < model.cluster_count; ++n) {
      const cluster = clusterAt(view, model.first_cluster + n);
      const key = 2 * cluster.material + (cluster.twoSided ? 1 : 0);
      if (!byKind.has(key)) byKind.set(key, []);
      byKind.get(key).push(cluster);
    }
    const group = new Group();
    for (const [key, clusters] of byKind) {
      const material = meshes.materials[key >> 1];
      const options = {
        side: key & 1 ? DoubleSide : FrontSide,
        alphaTest: material.alpha_cutoff,
        clippingPlanes: cut ? this.stage.clippingPlanes : null,
      };
      if (material.texture !== undefined) options.map = await this.texture(material.texture);
      else options.color = new Color().setRGB((material.color & 255) / 255, ((material.color >>> 8) & 255) / 255, ((material.color >>> 16) & 255) / 255, SRGBColorSpace);
      const geometry = geometryOf(clusters, arrays, model.step);
      if (material.texture !== undefined) freeWith(geometry, () => this.release(material.texture));
      group.add(this.mesh(geometry, options, geometry.hasAttribute("color")));
    }
    return group;
  }

  /// The surface of an object or link that was baked without render meshes.
  async surface(reference) {
    const arrays = await this.data.arrays(reference);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(arrays.positions, 3));
    geometry.setIndex(new BufferAttribute(arrays.corners, 1));
    const hasColors = arrays.colors.length > 0;
    if (hasColors) {
      const colors = Uint16Array.from({ length: 3 * arrays.colors.length },
        (_, n) => kLinear[(arrays.colors[Math.floor(n / 3)] >>> (8 * (n % 3))) & 255]);
      geometry.setAttribute("color", new BufferAttribute(colors, 3, true));
    }
    return this.mesh(geometry, { side: DoubleSide, color: hasColors ? 0xffffff : 0xb4b6ba }, false);
  }
}
