// Draws the skin by three.js: into textures, then onto the canvas with the occlusion that its depths show.

import {
  BufferAttribute, BufferGeometry, DepthTexture, Mesh, NearestFilter, PerspectiveCamera, RawShaderMaterial, Scene,
  UnsignedIntType, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget,
} from "three/build/three.module.js";

import {cameraOf} from "./camera.js";
import {colours, rgb} from "./colours.js";
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
    this.skinShader = material(skinVertex, skinFragment, {edge_width: 1}, true);
    this.skin = sceneOf(new BufferGeometry(), this.skinShader);
    this.screenShader = material(screenVertex, occlusionFragment, {
      image: this.target.texture, depths: this.target.depthTexture, pixel: new Vector2(), half_frustum: new Vector2(),
      near_far: new Vector2(), reach, top: new Vector3(), bottom: new Vector3(),
    }, false);
    const corners = new BufferGeometry();
    corners.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.screen = sceneOf(corners, this.screenShader);
  }

  setSkin({position, normal, colour: colourBytes}) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("normal", new BufferAttribute(normal, 4, true));
    geometry.setAttribute("colour", new BufferAttribute(colourBytes, 4, true));
    this.skin.mesh.geometry.dispose();
    this.skin.mesh.geometry = geometry;
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

  draw(state, scale) {
    this.setSize(scale);
    this.setCamera(cameraOf(state, this.canvas.width / this.canvas.height));
    this.skinShader.uniforms.edge_width.value = state.edges ? scale : 0;
    const {uniforms} = this.screenShader;
    uniforms.top.value.copy(colour(colours[state.theme].top));
    uniforms.bottom.value.copy(colour(colours[state.theme].bottom));
    this.gl.setRenderTarget(this.target);
    this.gl.render(this.skin.scene, this.camera);
    this.gl.setRenderTarget(null);
    this.gl.render(this.screen.scene, this.camera);
  }
}
