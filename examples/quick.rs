use sahlab::geom::*; use sahlab::kd::*; use sahlab::rays::*; use sahlab::kd::stream::*; use std::time::Instant; use sahlab::cost::*;
use glam::DVec3;
fn main(){
  let n:usize=std::env::args().nth(1).map(|s|s.parse().unwrap()).unwrap_or(100000);
  let mut u=Uniforms::starting_at(9,0);
  let e=(n as f64).powf(-1.0/3.0);
  let mut b=vec![];
  for _ in 0..n { let a=u.next4(); let c=DVec3::new(a[0],a[1],a[2]); let r=u.next4(); let q=glam::DQuat::from_euler(glam::EulerRot::XYZ, r[0]*6.28,r[1]*6.28,r[2]*6.28);
    let h=e/3f64.sqrt(); b.push(Triangle([0.,1.,2.].map(|k:f64| c+q*DVec3::new(h*(k*2.0944).cos(),h*(k*2.0944).sin(),0.))).bounds()); }
  let world=b.iter().fold(Aabb::EMPTY,|x,y|x.union(*y));
  for s in Strategy::ALL { 
    let t=Instant::now();
    let tree=build(&b,world,&Rules{strategy:s,stop:std::env::args().nth(2).unwrap_or("objects:2".into()).parse().unwrap(),cost:CostModel::WALD_HAVRAN});
    let bt=t.elapsed().as_secs_f64();
    let p=predict(&tree);
    println!("{s:24} build {bt:.3}s {:.3} Mtri/s nodes {} refs {} depth {} nK {:.2} nB {:.2} nt {:.2} C {:.1}", n as f64/bt/1e6, tree.nodes.len(),tree.references.len(),tree.depth,p.n_k,p.n_b,p.n_t,CostModel::WALD_HAVRAN.cost(p.n_k,p.n_b,p.n_t));
    if s==Strategy::Sah {
      if n<=2000 {audit::audit(&tree,&b).unwrap();}
      let l=SurfaceLines{world,seed:1};
      let t=Instant::now(); let v:Vec<Line>=l.range(0..1<<18).collect(); println!("lines {:.1} ns", t.elapsed().as_secs_f64()*1e9/v.len() as f64);
      let mut plain=Counts::new(&tree); let mut st=Stack::default();
      let t=Instant::now(); for x in &v { traverse::traverse_line(&tree,x,Span::FULL,&mut st,&mut plain);} plain.lines=v.len() as u64; let tp=t.elapsed().as_secs_f64();
      let mut c=Counts::new(&tree); let mut ss=Streams::default();
      for blk in [1<<14,1<<15,1<<16,1<<17,1<<18] { c=Counts::new(&tree);
      let t=Instant::now(); for ch in v.chunks(blk) { ss.count(&tree,ch,&mut c);} let ts=t.elapsed().as_secs_f64();
      println!("blk {blk} stream {:.3e}/s plain {:.3e}/s ratio {:.2} visits/line {:.1} eq {}", c.visits() as f64/ts, plain.visits() as f64/tp, tp/ts, c.visits() as f64/v.len() as f64, c==plain);}
      c.check(&tree).unwrap();
      println!("nK {:.3} nB {:.3} nt {:.3}", c.work.inner as f64/c.lines as f64, c.work.leaves as f64/c.lines as f64,c.work.tests as f64/c.lines as f64);
    }
  }
}
