// What pictures in 3D share: the light, the eye, and the canvas they are drawn on.
import {AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, WebGLRenderer} from 'three';

export class Stage {
  protected readonly renderer: WebGLRenderer;
  protected readonly scene = new Scene();
  protected readonly camera: PerspectiveCamera;

  /** `far`: how far the eye sees. Throws where the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement, paper: string, far: number) {
    this.renderer = new WebGLRenderer({canvas, antialias: true});
    this.camera = new PerspectiveCamera(32, 16 / 9, 0.05, far);
    this.scene.background = new Color(paper);
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(2, 5, 4);
    this.scene.add(new AmbientLight(0xffffff, 1.6), sun);
  }

  protected render() {
    this.renderer.render(this.scene, this.camera);
  }

  resize(width: number, height: number) {
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  dispose() {
    this.renderer.dispose();
  }
}
