// What pictures in 3D share: the light, the eye, and the canvas they are drawn on.
import {
  AmbientLight,
  Color,
  DirectionalLight,
  type Material,
  type Mesh,
  PerspectiveCamera,
  Scene,
  type WebGLRenderer,
} from 'three';

/** Of a canvas in the page: its own pixels are `ratio` times as many. */
export interface Size {
  width: number;
  height: number;
  ratio: number;
}

export class Stage {
  protected readonly scene = new Scene();
  protected readonly camera: PerspectiveCamera;

  /** `far`: how far the eye sees. */
  constructor(
    private readonly renderer: WebGLRenderer,
    paper: string,
    far: number,
  ) {
    this.camera = new PerspectiveCamera(32, 16 / 9, 0.05, far);
    this.scene.background = new Color(paper);
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(2, 5, 4);
    this.scene.add(new AmbientLight(0xffffff, 1.6), sun);
  }

  protected render() {
    this.renderer.render(this.scene, this.camera);
  }

  resize({width, height, ratio}: Size) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  dispose() {
    this.scene.traverse((object) => {
      const {geometry, material} = object as Partial<Mesh>;
      geometry?.dispose();
      const materials: Material[] = Array.isArray(material) ? material : material ? [material] : [];
      for (const each of materials) each.dispose();
    });
  }
}
