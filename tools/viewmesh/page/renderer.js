// Draws the skin by three.js: into textures, then onto the canvas with the occlusion that its depths show. Dislocations
// come last, over both.

import {
  BufferAttribute, BufferGeometry, DepthTexture, Mesh, NearestFilter, PerspectiveCamera, RawShaderMaterial, Scene,
  UnsignedIntType, Vector2, Vector3, Vector4, WebGLRenderer, WebGLRenderTarget,
} from "three/build/three.module.js";

import {axesOf} from "./camera.js";
import {colours, rgb} from "./colours.js";
import lineFragment from "./line.frag";
import lineVertex from "./line.vert";
import occlusionFragment from "./occlusion.frag";
import screenVertex from "./screen.vert";
import skinFragment from "./skin.frag";
import skinVertex from "./skin.vert";

const head = "#version 300 es\nprecision highp float;\nprecision highp int;\n";

function material(vertex, fragment, uniforms, depthTest) {
  return new RawShaderMaterial({
    vertexShader: head + vertex, fragmentShader: head + fragment, depthTest, depthWrite: depthTest, side: 2,
    uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, {value}])),
  });
}

function sceneOf(geometry, shader) {
  const scene = new Scene(), mesh = new Mesh(geometry, shader);
  mesh.frustumCulled = false;
  scene.add(mesh);
  return {scene, mesh};
}

// Of dislocations, in pixels of the page; and of the one that was found, as a part of it.
const lineWidth = 2.5, chosenWidth = 2;

const colour = text => new Vector3(...rgb(text).map(value => value / 255));

export class Renderer {
  constructor(canvas, reach) {
    const context = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!context) throw new Error("This browser does not offer WebGL 2.");
    this.canvas = canvas;
    this.gl = new WebGLRenderer({canvas, context});
    this.target = new WebGLRenderTarget(1, 1, {minFilter: NearestFilter, magFilter: NearestFilter});
    this.target.depthTexture = new DepthTexture(1, 1, UnsignedIntType);
    this.camera = new PerspectiveCamera();
    this.camera.matrixAutoUpdate = false;
    this.skinShader = material(skinVertex, skinFragment, {edge_width: 1, up_axis: new Vector3()}, true);
    this.skin = sceneOf(new BufferGeometry(), this.skinShader);
    this.screenShader = material(screenVertex, occlusionFragment, {
      image: this.target.texture, depths: this.target.depthTexture, pixel: new Vector2(), half_frustum: new Vector2(),
      near_far: new Vector2(), reach, top: new Vector3(), bottom: new Vector3(),
    }, false);
    const corners = new BufferGeometry();
    corners.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.screen = sceneOf(corners, this.screenShader);
    this.lineShader = material(lineVertex, lineFragment, {
      depths: this.target.depthTexture, pixel: new Vector2(), viewport: new Vector2(), clip: new Vector4(),
      line_colour: colour(colours.dislocations), width: 1,
    }, false);
    this.lineShader.transparent = true;
    this.lines = new Mesh(new BufferGeometry(), this.lineShader);
    this.lines.frustumCulled = this.lines.visible = false;
    this.screen.scene.add(this.lines);
  }

  setSkin({position, normal, colour: colourBytes}) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("normal", new BufferAttribute(normal, 4, true));
    geometry.setAttribute("colour", new BufferAttribute(colourBytes, 4, true));
    this.skin.mesh.geometry.dispose();
    this.skin.mesh.geometry = geometry;
  }

  // Lines as decode.js has them; the one of number `chosen` is thicker.
  setLines(lines, chosen) {
    const position = [], other = [], side = [];
    lines.forEach(({points}, number) => {
      const width = number === chosen ? chosenWidth : 1;
      for (let i = 3; i < points.length; i += 3) {
        const a = points.subarray(i - 3, i), b = points.subarray(i, i + 3);
        // What is left of a line seen from its end is right of it seen from its begin.
        for (const [here, there, left] of [[a, b, 1], [a, b, -1], [b, a, 1], [a, b, 1], [b, a, 1], [b, a, -1]]) {
          position.push(...here);
          other.push(...there);
          side.push(left * width);
        }
      }
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(position), 3));
    geometry.setAttribute("other", new BufferAttribute(new Float32Array(other), 3));
    geometry.setAttribute("side", new BufferAttribute(new Float32Array(side), 1));
    this.lines.geometry.dispose();
    this.lines.geometry = geometry;
  }

  // `scale`: pixels of the canvas for one of the page.
  setSize(scale) {
    const width = Math.round(this.canvas.clientWidth * scale), height = Math.round(this.canvas.clientHeight * scale);
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.gl.setSize(width, height, false);
    this.target.setSize(width, height);
  }

  setCamera(view) {
    const [across, up] = view.halfFrustum, {near, far} = view;
    this.camera.matrix.makeBasis(new Vector3(...view.right), new Vector3(...view.up), new Vector3(...view.towards))
      .setPosition(...view.eye);
    this.camera.matrixWorldNeedsUpdate = true;
    this.camera.projectionMatrix.makePerspective(-near * across, near * across, near * up, -near * up, near, far);
    const {uniforms} = this.screenShader;
    uniforms.half_frustum.value.set(across, up);
    uniforms.near_far.value.set(near, far);
    uniforms.pixel.value.set(1 / this.canvas.width, 1 / this.canvas.height);
  }

  // `beyond`: how far along the clip's normal the picture goes.
  setUniforms(state, scale, beyond) {
    this.skinShader.uniforms.edge_width.value = state.edges ? scale : 0;
    this.skinShader.uniforms.up_axis.value.set(...axesOf(state.up)[2]);
    const {clip, pixel, viewport, width} = this.lineShader.uniforms;
    clip.value.set(...state.clip?.normal ?? [0, 0, 0], beyond);
    viewport.value.set(this.canvas.width, this.canvas.height);
    pixel.value.set(1 / this.canvas.width, 1 / this.canvas.height);
    width.value = lineWidth * scale;
    this.lines.visible = state.dislocations && this.lines.geometry.attributes.position !== undefined;
    const {uniforms} = this.screenShader;
    uniforms.top.value.copy(colour(colours[state.theme].top));
    uniforms.bottom.value.copy(colour(colours[state.theme].bottom));
  }

  draw(view, state, scale, beyond) {
    this.setSize(scale);
    this.setCamera(view);
    this.setUniforms(state, scale, beyond);
    this.gl.setRenderTarget(this.target);
    this.gl.render(this.skin.scene, this.camera);
    this.gl.setRenderTarget(null);
    this.gl.render(this.screen.scene, this.camera);
  }
}
